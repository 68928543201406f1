#!/usr/bin/env python3
"""simulate.py [--edge-length PERCENT] [--scalefcn PROGRAM] PART.off...: is an adapted surface better to simulate on?

Each part is tetrahedralised by gmsh, its surface left as it is, from four surfaces: the input (raw); a remesh
that keeps nothing (plain); one that keeps all sharp edges (threshold); and one that keeps the adapted network
(adapted); the last three with the same target length, PERCENT of the diagonal (default 3). Prints Markdown:
whether gmsh fails, tetrahedra, the worst and the mean quality (3 r / R, inscribed over circumscribed radius: 1 is a
regular tetrahedron), the shortest altitude as a share of the target length, which bounds the time step of an
explicit method, and the iterations of conjugate gradients, plain and with the diagonal as preconditioner, for
Laplace's equation with linear elements, 0 and 1 on the ends of the longest axis, to a residual of 1e-8.

Needs gmsh (Debian), and numpy and scipy (scripts/setup_experiments.sh numpy scipy); ends with 77 without them.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy import sparse
except ImportError as error:
    print(f"simulate.py: {error.name} is not installed (scripts/setup_experiments.sh numpy scipy)", file=sys.stderr)
    sys.exit(77)

RESIDUAL = 1e-8
MOST_ITERATIONS = 20000
END_SHARE = 0.02  # of the longest axis, at either end
GMSH_SECONDS = 300


def read_off(path):
    words = path.read_text(encoding="ascii").split()
    try:
        if words[0] != "OFF":
            raise ValueError
        vertices, faces = int(words[1]), int(words[2])
        middle = 4 + 3 * vertices
        points = np.array(words[4:middle], dtype=float).reshape(vertices, 3)
        triangles = np.array(words[middle : middle + 4 * faces], dtype=int).reshape(faces, 4)[:, 1:]
    except (ValueError, IndexError) as error:
        raise ValueError(f"{path}: not an OFF file of triangles") from error
    return points, triangles


def write_surface(path, points, triangles):
    """As gmsh's format 2.2, one discrete surface, so that gmsh does not look for features."""
    with open(path, "w", encoding="ascii") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        for number, (x, y, z) in enumerate(points.tolist(), 1):
            file.write(f"{number} {x!r} {y!r} {z!r}\n")
        file.write(f"$EndNodes\n$Elements\n{len(triangles)}\n")
        for number, (a, b, c) in enumerate(triangles + 1, 1):
            file.write(f"{number} 2 2 1 1 {a} {b} {c}\n")
        file.write("$EndElements\n")


def read_tetrahedra(path):
    points, tetrahedra = {}, []
    with open(path, encoding="ascii") as file:
        lines = iter(file)
        for line in lines:
            if line.startswith("$Nodes"):
                for _ in range(int(next(lines))):
                    number, *position = next(lines).split()
                    points[int(number)] = [float(x) for x in position]
            elif line.startswith("$Elements"):
                for _ in range(int(next(lines))):
                    words = [int(word) for word in next(lines).split()]
                    if words[1] == 4:
                        tetrahedra.append(words[3 + words[2] :])
    used = sorted({node for tetrahedron in tetrahedra for node in tetrahedron})
    rank = {node: index for index, node in enumerate(used)}
    return (
        np.array([points[node] for node in used]).reshape(-1, 3),
        np.array([[rank[node] for node in tetrahedron] for tetrahedron in tetrahedra]).reshape(-1, 4),
    )


def tetrahedralise(points, triangles, folder):
    """None where gmsh fails or runs out of time."""
    surface, script, volume = folder / "surface.msh", folder / "volume.geo", folder / "volume.msh"
    write_surface(surface, points, triangles)
    script.write_text(
        f'Merge "{surface}";\nSurface Loop(1) = {{1}};\nVolume(1) = {{1}};\nMesh.SaveAll = 1;\n'
        "Mesh.MshFileVersion = 2.2;\nMesh.Optimize = 1;\n",
        encoding="ascii",
    )
    volume.unlink(missing_ok=True)
    command = ["gmsh", str(script), "-3", "-nt", "1", "-v", "1", "-o", str(volume)]
    try:
        subprocess.run(command, check=False, timeout=GMSH_SECONDS, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        nodes, tetrahedra = read_tetrahedra(volume)
    except (subprocess.TimeoutExpired, OSError, ValueError, KeyError, StopIteration):
        return None
    return (nodes, tetrahedra) if len(tetrahedra) else None


def qualities(points, tetrahedra):
    """3 r / R, and the shortest altitude, of each."""
    a, b, c, d = (points[tetrahedra[:, k]] for k in range(4))
    u, v, w = b - a, c - a, d - a
    volume = np.abs(np.einsum("ij,ij->i", u, np.cross(v, w))) / 6
    areas = 0.5 * np.stack(
        [np.linalg.norm(np.cross(x, y), axis=1) for x, y in ((u, v), (u, w), (v, w), (c - b, d - b))], axis=1
    )
    inner = 3 * volume / areas.sum(axis=1)
    squares = [np.einsum("ij,ij->i", x, x)[:, None] for x in (u, v, w)]
    centre = squares[0] * np.cross(v, w) + squares[1] * np.cross(w, u) + squares[2] * np.cross(u, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        outer = np.linalg.norm(centre, axis=1) / (12 * volume)
        quality = np.where(volume > 0, 3 * inner / outer, 0.0)
        altitude = 3 * volume / areas.max(axis=1)
    return quality, altitude


def stiffness(points, tetrahedra):
    """Of Laplace's equation with linear elements."""
    a, b, c, d = (points[tetrahedra[:, k]] for k in range(4))
    frames = np.stack([b - a, c - a, d - a], axis=1)
    volume = np.abs(np.linalg.det(frames)) / 6
    good = volume > 1e-14 * volume.max()
    frames, volume, corners = frames[good], volume[good], tetrahedra[good]
    inner = np.transpose(np.linalg.inv(frames), (0, 2, 1))
    gradients = np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)
    local = np.einsum("nik,njk,n->nij", gradients, gradients, volume)
    rows = np.repeat(corners, 4, axis=1).ravel()
    columns = np.tile(corners, (1, 4)).ravel()
    size = len(points)
    return sparse.csr_matrix((local.ravel(), (rows, columns)), shape=(size, size))


def iterations(matrix, right, diagonal):
    """Of conjugate gradients with 1 / diagonal as preconditioner."""
    x = np.zeros_like(right)
    r = right.copy()
    z = r / diagonal
    p = z.copy()
    rho = r @ z
    goal = RESIDUAL * np.linalg.norm(right)
    for count in range(MOST_ITERATIONS):
        if np.linalg.norm(r) <= goal:
            return count
        q = matrix @ p
        alpha = rho / (p @ q)
        x += alpha * p
        r -= alpha * q
        z = r / diagonal
        previous, rho = rho, r @ z
        p = z + (rho / previous) * p
    return MOST_ITERATIONS


def solve(points, tetrahedra):
    """Iterations of conjugate gradients: plain, and with the diagonal."""
    extent = np.ptp(points, axis=0)
    axis = int(np.argmax(extent))
    height = (points[:, axis] - points[:, axis].min()) / extent[axis]
    values = np.where(height > 1 - END_SHARE, 1.0, 0.0)
    fixed = (height < END_SHARE) | (height > 1 - END_SHARE)
    matrix = stiffness(points, tetrahedra)
    free = np.flatnonzero(~fixed & (matrix.diagonal() > 0))
    inner = matrix[free][:, free]
    right = -(matrix @ np.where(fixed, values, 0.0))[free]
    if not len(free) or not np.any(right):
        return None
    return iterations(inner, right, np.ones(len(free))), iterations(inner, right, inner.diagonal())


def surfaces(part, percent, program, folder):
    """(name, points, triangles) of each surface; the target length."""

    def call(*words):
        done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr.strip()}")

    points, triangles = read_off(part)
    length = percent / 100 * float(np.linalg.norm(np.ptp(points, axis=0)))
    initial, adapted = folder / "initial.fcn.json", folder / "adapted.fcn.json"
    call("detect", part, "--method", "sharp", "-o", initial)
    call("adapt", part, "--network", initial, "--edge-length", repr(length), "-o", adapted)
    yield "raw", points, triangles, length
    for name, network in (("plain", None), ("threshold", initial), ("adapted", adapted)):
        target = folder / f"{name}.off"
        call("remesh", part, "--edge-length", repr(length), "-o", target, *(["--network", network] if network else []))
        yield name, *read_off(target), length


def print_summary(rows):
    """Medians over the parts of which every surface could be tetrahedralised."""
    kinds = list(dict.fromkeys(row["surface"] for row in rows))
    parts = list(dict.fromkeys(row["part"] for row in rows))
    made = {(row["part"], row["surface"]): row for row in rows if row.get("iterations")}
    common = [part for part in parts if all((part, kind) in made for kind in kinds)]
    if not common:
        return
    print(f"\n| surface | tetrahedralised | medians of {len(common)}: worst quality | shortest altitude | CG | CG, diagonal |")
    print("|---|---|---|---|---|---|")
    for kind in kinds:
        chosen = [made[part, kind] for part in common]
        middle = [
            float(np.median([row[key] for row in chosen])) for key in ("worst_quality", "shortest_altitude")
        ] + [float(np.median([row["iterations"][k] for row in chosen])) for k in (0, 1)]
        count = sum((part, kind) in made for part in parts)
        print(f"| {kind} | {count} of {len(parts)} | {middle[0]:.4f} | {middle[1]:.5f} | {middle[2]:.0f} | {middle[3]:.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="+", type=pathlib.Path, metavar="PART.off")
    parser.add_argument("--edge-length", type=float, default=3.0, metavar="PERCENT", help="of the diagonal (3)")
    parser.add_argument("--scalefcn", default="scalefcn", metavar="PROGRAM")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="all numbers")
    arguments = parser.parse_args()
    if not 0.01 <= arguments.edge_length <= 50:
        parser.error("--edge-length: from 0.01 to 50 percent")
    missing = [tool for tool in ("gmsh", arguments.scalefcn) if shutil.which(tool) is None]
    if missing:
        print(f"simulate.py: {', '.join(missing)} not found", file=sys.stderr)
        return 77
    print("| part | surface | triangles | tetrahedra | worst quality | mean quality | shortest altitude | CG | CG, diagonal |")
    print("|---|---|---|---|---|---|---|---|---|")
    rows = []
    for part in arguments.parts:
        if not part.is_file():
            parser.error(f"{part}: no such file")
    for part in arguments.parts:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for kind, points, triangles, length in surfaces(part, arguments.edge_length, arguments.scalefcn, folder):
                row = {"part": part.stem, "surface": kind, "triangles": len(triangles)}
                mesh = tetrahedralise(points, triangles, folder)
                if mesh is None:
                    print(f"| {part.stem} | {kind} | {len(triangles)} | fails | | | | | |", flush=True)
                else:
                    quality, altitude = qualities(*mesh)
                    counts = solve(*mesh)
                    row |= {
                        "tetrahedra": len(mesh[1]),
                        "worst_quality": float(quality.min()),
                        "mean_quality": float(quality.mean()),
                        "shortest_altitude": float(altitude.min() / length),
                        "iterations": counts,
                    }
                    print(
                        f"| {part.stem} | {kind} | {len(triangles)} | {len(mesh[1])} | {quality.min():.4f} | "
                        f"{quality.mean():.3f} | {altitude.min() / length:.5f} | "
                        + (f"{counts[0]} | {counts[1]} |" if counts else "- | - |"),
                        flush=True,
                    )
                rows.append(row)
    print_summary(rows)
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError, RuntimeError) as error:
        sys.exit(f"simulate.py: {error}")
