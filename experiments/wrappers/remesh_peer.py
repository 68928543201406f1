#!/usr/bin/env python3
"""remesh_peer.py gmsh|meshlab IN.obj OUT.off LENGTH: a triangle mesh of edge length LENGTH by another
program, for comparisons (pip install gmsh pymeshlab). Prints the CPU seconds of the remeshing."""
import sys
import time


def by_meshlab(source, target, length):
    import pymeshlab

    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(source)
    start = time.process_time()
    meshes.meshing_isotropic_explicit_remeshing(
        iterations=10, targetlen=pymeshlab.PureValue(length), featuredeg=40, checksurfdist=False)
    seconds = time.process_time() - start
    meshes.save_current_mesh(target)
    return seconds


def by_gmsh(source, target, length):
    import math

    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.merge(source)
    start = time.process_time()
    gmsh.model.mesh.classifySurfaces(math.radians(40), True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    gmsh.option.setNumber("Mesh.MeshSizeMin", length)
    gmsh.option.setNumber("Mesh.MeshSizeMax", length)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.model.mesh.generate(2)
    seconds = time.process_time() - start
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = {tag: i for i, tag in enumerate(tags)}
    _, corners = gmsh.model.mesh.getElementsByType(2)
    with open(target, "w", encoding="ascii") as out:
        out.write(f"OFF\n{len(tags)} {len(corners) // 3} 0\n")
        for i in range(len(tags)):
            out.write("{!r} {!r} {!r}\n".format(*(float(x) for x in coordinates[3 * i:3 * i + 3])))
        for i in range(0, len(corners), 3):
            out.write("3 " + " ".join(str(number[tag]) for tag in corners[i:i + 3]) + "\n")
    return seconds


def main():
    if len(sys.argv) != 5 or sys.argv[1] not in ("gmsh", "meshlab"):
        sys.exit(__doc__)
    make = by_gmsh if sys.argv[1] == "gmsh" else by_meshlab
    print(f"{make(sys.argv[2], sys.argv[3], float(sys.argv[4])):.3f}")


if __name__ == "__main__":
    main()
