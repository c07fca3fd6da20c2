"""A frame as polygons of VTK."""

from __future__ import annotations

import copy

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray


def fill(output, frame):
    """Puts the frame's surface into a vtkPolyData. The frame itself stays encoded."""
    mesh = copy.copy(frame).mesh
    points = vtkPoints()
    points.SetData(numpy_to_vtk(mesh.vertices, deep=True))
    output.SetPoints(points)
    triangles = vtkCellArray()
    triangles.SetData(3, numpy_to_vtkIdTypeArray(mesh.triangles.ravel().astype(np.int64), deep=True))
    output.SetPolys(triangles)
    if mesh.normals is not None:
        normals = numpy_to_vtk(mesh.normals, deep=True)
        normals.SetName("Normals")
        output.GetPointData().SetNormals(normals)
    for name, values in mesh.attributes.items():
        _add(output.GetPointData(), name, values)
    _add(output.GetCellData(), "level", mesh.levels)
    _add(output.GetFieldData(), "frame", np.array([frame.index], np.int64))
    _add(output.GetFieldData(), "time", np.array([frame.time]))


def _add(data, name, values):
    array = numpy_to_vtk(values, deep=True)
    array.SetName(name)
    data.AddArray(array)
