"""Opens an exported mesh with one reader and prints what it found as JSON: vertices, triangles,
quads, lines (edges of curves), length (of all lines), and data of cells by name, as far as the
reader knows them.

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
    if path.endswith(".vtu"):
        return with_vtk_cells(path)
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
    sides = []
    polygons = data.GetPolys()
    polygons.InitTraversal()
    while polygons.GetNextCell(cell):
        sides.append(cell.GetNumberOfIds())
    return {"vertices": len(points), "triangles": sides.count(3), "quads": sides.count(4),
            "lines": len(pairs), "length": length_of(points, pairs)}


def with_vtk_cells(path):
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    kinds = [data.GetCellType(k) for k in range(data.GetNumberOfCells())]
    pairs = []
    for k, kind in enumerate(kinds):
        if kind == 3:
            line = data.GetCell(k)
            pairs.append((line.GetPointId(0), line.GetPointId(1)))
    points = [data.GetPoint(k) for k in range(data.GetNumberOfPoints())]
    arrays = data.GetCellData()
    values = {arrays.GetArrayName(i): [arrays.GetArray(i).GetValue(k) for k in range(len(kinds))]
              for i in range(arrays.GetNumberOfArrays())}
    return {"vertices": len(points), "triangles": kinds.count(5), "quads": kinds.count(9),
            "lines": kinds.count(3), "length": length_of(points, pairs), "data": values}


def with_meshio(path):
    import meshio
    mesh = meshio.read(path)
    triangles = mesh.cells_dict.get("triangle", [])
    lines = mesh.cells_dict.get("line", [])
    found = {"vertices": len(mesh.points), "triangles": len(triangles),
             "quads": len(mesh.cells_dict.get("quad", [])), "lines": len(lines),
             "length": length_of(mesh.points, lines)}
    if mesh.cell_data:
        found["data"] = {name: [float(x) for part in parts for x in part]
                         for name, parts in mesh.cell_data.items()}
    return found


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
