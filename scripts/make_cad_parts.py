#!/usr/bin/env python3
"""make_cad_parts.py [--list] [--faces N] [-o FOLDER] [PART...]: triangle meshes of real CAD parts, with truth.

The parts are CAD models in Debian's packages occt-misc, netgen-doc and gmsh-doc, which are downloaded
but not installed; gmsh (Debian) meshes them with about N faces (default 20000). For each part
FOLDER (default build/cad) gets NAME.off and NAME.cadedges.txt: the mesh edges, as pairs of vertex
numbers from 0, that lie on curves of the CAD model, smooth seams included. What is there already is
left alone. Ends with 77 where gmsh or apt-get is missing.
"""

import argparse
import gzip
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
OCC = ("occt-misc", "usr/share/opencascade/data")
NETGEN = ("netgen-doc", "usr/share/doc/netgen/examples")
GMSH = ("gmsh-doc", "usr/share/doc/gmsh-doc")
PARTS = {
    "CrankArm": (*OCC, "occ/CrankArm.brep"),
    "pump-cover": (*OCC, "occ/Pump_TopCover.brep"),
    "hammer": (*OCC, "occ/hammer.brep"),
    "bottle": (*OCC, "occ/bottle.brep"),
    "nut": (*OCC, "occ/mal_ecrou.brep"),
    "rod": (*OCC, "occ/mal_tige.brep"),
    "piston": (*OCC, "occ/Piston.rle"),
    "engine-block": (*OCC, "occ/EngineBlock.rle"),
    "cylinder-head": (*OCC, "occ/CylinderHead.rle"),
    "fuse": (*OCC, "occ/fuse.brep"),
    "linkrods": (*OCC, "step/linkrods.step"),
    "frame": (*NETGEN, "frame.step"),
    "screw": (*NETGEN, "screw.step"),
    "component": (*GMSH, "doc/gmsh/demos/boolean/component8.step.gz"),
}
NOT_HERE = 77
TRIES = 4


def run(command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.DEVNULL, **options)


def download(package, folder):
    """The unpacked files of a Debian package."""
    target = folder / package
    if not target.is_dir():
        run(["apt-get", "download", package], cwd=folder, stderr=subprocess.DEVNULL)
        archive = next(folder.glob(f"{package}_*.deb"))
        run(["dpkg-deb", "-x", str(archive), str(target)])
    return target


def read_msh(path):
    """Points, triangles and edges on curves of an ASCII gmsh file, format 2.2, vertices from 0."""
    points, triangles, edges = {}, [], set()
    with open(path, encoding="ascii") as file:
        lines = iter(file)
        for line in lines:
            if line.startswith("$Nodes"):
                for _ in range(int(next(lines))):
                    number, x, y, z = next(lines).split()
                    points[int(number)] = (float(x), float(y), float(z))
            elif line.startswith("$Elements"):
                for _ in range(int(next(lines))):
                    words = [int(word) for word in next(lines).split()]
                    nodes = words[3 + words[2] :]
                    if words[1] == 1:
                        edges.add(tuple(sorted(nodes)))
                    elif words[1] == 2:
                        triangles.append(tuple(nodes))
    used = sorted({node for triangle in triangles for node in triangle})
    rank = {node: index for index, node in enumerate(used)}
    sides = set()
    for a, b, c in triangles:
        sides.update(tuple(sorted(side)) for side in ((a, b), (b, c), (c, a)))
    return (
        [points[node] for node in used],
        [tuple(rank[node] for node in triangle) for triangle in triangles],
        sorted((rank[a], rank[b]) for a, b in edges & sides),
    )


def mesh_part(model, size, folder):
    """Triangles with edges of about `size`; without a size as large as gmsh likes."""
    target = folder / "part.msh"
    run(
        ["gmsh", str(model), "-2", "-nt", "1", "-v", "1", *(["-clmax", repr(size), "-clmin", repr(size / 4)] if size else []),
         "-setnumber", "Mesh.MeshSizeFromCurvature", "12", "-format", "msh22", "-save_all", "-o", str(target)]
    )  # fmt: skip
    return read_msh(target)


def area(points, triangles):
    total = 0.0
    for a, b, c in triangles:
        u = [points[b][k] - points[a][k] for k in range(3)]
        v = [points[c][k] - points[a][k] for k in range(3)]
        cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        total += 0.5 * math.sqrt(sum(x * x for x in cross))
    return total


def make(name, faces, target, scratch):
    package, prefix, path = PARTS[name]
    source = download(package, scratch) / prefix / path
    suffix = ".brep" if path.endswith(".rle") else "." + path.split(".")[1]
    model = scratch / f"{name}{suffix}"
    if path.endswith(".gz"):
        with gzip.open(source) as packed, open(model, "wb") as file:
            shutil.copyfileobj(packed, file)
    else:
        shutil.copyfile(source, model)
    # A first mesh tells the area, which tells the edge length for so many faces.
    points, triangles, edges = mesh_part(model, None, scratch)
    size = math.sqrt(area(points, triangles) / faces * 4 / math.sqrt(3))
    for _ in range(TRIES):
        points, triangles, edges = mesh_part(model, size, scratch)
        share = len(triangles) / faces
        if 0.7 < share < 1.4:
            break
        size *= math.sqrt(share)
    rows = [f"OFF\n{len(points)} {len(triangles)} 0\n"]
    rows += [f"{x!r} {y!r} {z!r}\n" for x, y, z in points]
    rows += [f"3 {a} {b} {c}\n" for a, b, c in triangles]
    for file, text in (
        (target / f"{name}.cadedges.txt", "".join(f"{a} {b}\n" for a, b in edges)),
        (target / f"{name}.off", "".join(rows)),
    ):
        part = file.with_name(file.name + ".part")
        part.write_text(text, encoding="ascii")
        part.replace(file)
    return len(triangles), len(edges)


def main():
    parser = argparse.ArgumentParser(description="triangle meshes of CAD parts from Debian packages")
    parser.add_argument("parts", nargs="*", metavar="PART", help="default: all")
    parser.add_argument("--list", action="store_true", help="print the names")
    parser.add_argument("--faces", type=int, default=20000, metavar="N", help="about so many (20000)")
    parser.add_argument("-o", type=pathlib.Path, default=ROOT / "build/cad", metavar="FOLDER", dest="folder")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.parts if name not in PARTS]
    if unknown:
        parser.error(f"no part {', '.join(unknown)}; there are: {', '.join(PARTS)}")
    if not 100 <= arguments.faces <= 10_000_000:
        parser.error("--faces: from 100 to 10000000")
    if arguments.list:
        print("\n".join(PARTS))
        return 0
    missing = [tool for tool in ("gmsh", "apt-get", "dpkg-deb") if shutil.which(tool) is None]
    if missing:
        print(f"make_cad_parts.py: {', '.join(missing)} not installed", file=sys.stderr)
        return NOT_HERE
    arguments.folder.mkdir(parents=True, exist_ok=True)
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.parts or PARTS:
            file = arguments.folder / f"{name}.off"
            if not file.exists():
                try:
                    faces, edges = make(name, arguments.faces, arguments.folder, pathlib.Path(folder))
                except (subprocess.CalledProcessError, OSError, ValueError) as error:
                    print(f"{name}: {error}", file=sys.stderr)
                    failed = True
                    continue
                print(f"{name}: {faces} faces, {edges} edges on curves", file=sys.stderr)
            print(file)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
