"""Opens an exported mesh with one reader and prints what it found as JSON: vertices, triangles,
lines (edges of curves), and length (of all lines), as far as the reader knows them.

Usage: read_with.py gmsh|vtk|meshio|pymeshlab FILE   (exit code 77: the reader is not installed)
"""

import json
import math
import sys


def length_of(points, pairs):
    return sum(math.dist(points[a], points[b]) for a, b in pairs)


def with_gmsh(path):
    import gmsh
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(path)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = {tag: tuple(coordinates[3 * i:3 * i + 3]) for i, tag in enumerate(tags)}
    _, line_nodes = gmsh.model.mesh.getElementsByType(1)
    triangles, _ = gmsh.model.mesh.getElementsByType(2)
    pairs = list(zip(line_nodes[0::2], line_nodes[1::2]))
    return {"vertices": len(tags), "triangles": len(triangles), "lines": len(pairs),
            "curves": len(gmsh.model.getEntities(1)), "length": length_of(points, pairs)}


def with_vtk(path):
    from vtkmodules.vtkIOGeometry import vtkOBJReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    kinds = {".vtp": vtkXMLPolyDataReader, ".obj": vtkOBJReader, ".ply": vtkPLYReader}
    reader = kinds[path[path.rindex("."):]]()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    lines = data.GetLines()
    pairs = []
    lines.InitTraversal()
    from vtkmodules.vtkCommonCore import vtkIdList
    cell = vtkIdList()
    while lines.GetNextCell(cell):
        ids = [cell.GetId(k) for k in range(cell.GetNumberOfIds())]
        pairs += zip(ids, ids[1:])
    points = [data.GetPoint(k) for k in range(data.GetNumberOfPoints())]
    return {"vertices": len(points), "triangles": data.GetNumberOfPolys(), "lines": len(pairs),
            "length": length_of(points, pairs)}


def with_meshio(path):
    import meshio
    mesh = meshio.read(path)
    triangles = mesh.cells_dict.get("triangle", [])
    lines = mesh.cells_dict.get("line", [])
    return {"vertices": len(mesh.points), "triangles": len(triangles), "lines": len(lines),
            "length": length_of(mesh.points, lines)}


def with_pymeshlab(path):
    import pymeshlab
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(path)
    mesh = meshes.current_mesh()
    found = {"vertices": mesh.vertex_number(), "triangles": mesh.face_number()}
    if mesh.edge_number() > 0:
        found["lines"] = mesh.edge_number()
        found["length"] = length_of(mesh.vertex_matrix(), mesh.edge_matrix())
    return found


def main():
    readers = {"gmsh": with_gmsh, "vtk": with_vtk, "meshio": with_meshio,
               "pymeshlab": with_pymeshlab}
    try:
        found = readers[sys.argv[1]](sys.argv[2])
    except ImportError as error:
        print(error, file=sys.stderr)
        sys.exit(77)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
