"""Meshes as those of other libraries, which are imported when they are asked for: this package needs none of them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .mesh import Mesh


def to_pyvista(mesh: Mesh) -> Any:
    faces = np.empty((len(mesh.triangles), 4), np.int64)
    faces[:, 0] = 3
    faces[:, 1:] = mesh.triangles
    made = _library("pyvista", "pyvista").PolyData(mesh.vertices32, faces.ravel())
    if mesh.normals is not None:
        made.point_data["Normals"] = mesh.normals
    for name, values in mesh.attributes.items():
        made.point_data[name] = values
    made.cell_data["level"] = mesh.levels
    return made


def to_trimesh(mesh: Mesh) -> Any:
    return _library("trimesh", "trimesh").Trimesh(
        vertices=mesh.vertices,
        faces=mesh.triangles,
        vertex_normals=mesh.normals,
        vertex_attributes={name: np.array(values) for name, values in mesh.attributes.items()},
        process=False,  # which would merge and reorder
    )


def to_open3d(mesh: Mesh) -> Any:
    open3d = _library("open3d", "python3-open3d of Debian, or open3d")

    def tensor(values: Any, dtype: Any = None) -> Any:
        return open3d.core.Tensor(np.array(values, dtype))  # a copy: ours cannot be written to

    made = open3d.t.geometry.TriangleMesh(tensor(mesh.vertices32), tensor(mesh.triangles, np.int32))
    if mesh.normals is not None:
        made.vertex.normals = tensor(mesh.normals)
    for name, values in mesh.attributes.items():
        # It knows neither uint32 nor arrays of one dimension.
        wider = np.int64 if values.dtype == np.uint32 else None
        made.vertex[name] = tensor(values.reshape(len(values), -1), wider)
    made.triangle.level = tensor(mesh.levels.reshape(-1, 1))
    return made


def _library(module: str, package: str) -> Any:
    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(f"there is no module {module} here: install {package}", name=module) from error
