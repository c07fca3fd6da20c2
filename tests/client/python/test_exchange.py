"""Meshes as those of other libraries: of stand-ins that keep what they are given, and of Open3D where it is there."""

import sys
import types

import meniscus
import numpy as np
import pytest
from support.closedness import is_closed
from support.particles import particle_radius


class Given:
    """What a class of another library was made of, and what was set in it."""

    def __init__(self, *arguments, **keywords):
        self.arguments = arguments
        self.keywords = keywords
        self.point_data = {}
        self.cell_data = {}


@pytest.fixture
def stand_in(monkeypatch):
    def put(name, **members):
        module = types.ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)

    return put


@pytest.fixture
def carried(positions):
    numbers = np.arange(len(positions))
    return meniscus.reconstruct(
        positions,
        particle_radius,
        attributes={"velocity": positions * 3, "id": numbers.astype(np.uint32), "age": numbers.astype(np.float32)},
    )


def test_pyvista_is_given_faces_attributes_and_levels(stand_in, carried):
    stand_in("pyvista", PolyData=Given)
    made = carried.to_pyvista()
    vertices, faces = made.arguments
    assert vertices is carried.vertices32
    assert faces.dtype == np.int64 and (faces.reshape(-1, 4)[:, 0] == 3).all()
    assert np.array_equal(faces.reshape(-1, 4)[:, 1:], carried.triangles)
    assert list(made.point_data) == ["Normals", "velocity", "id", "age"]
    assert made.point_data["velocity"] is carried.attributes["velocity"]
    assert np.array_equal(made.cell_data["level"], carried.levels)


def test_trimesh_is_given_what_it_shall_not_reorder(stand_in, carried):
    stand_in("trimesh", Trimesh=Given)
    given = carried.to_trimesh().keywords
    assert given["process"] is False
    assert given["vertices"] is carried.vertices
    assert np.array_equal(given["faces"], carried.triangles)
    assert np.array_equal(given["vertex_normals"], carried.normals)
    assert list(given["vertex_attributes"]) == ["velocity", "id", "age"]


def test_without_normals_none_are_given(stand_in, positions):
    stand_in("pyvista", PolyData=Given)
    stand_in("trimesh", Trimesh=Given)
    mesh = meniscus.reconstruct(positions, particle_radius, normals=False)
    assert "Normals" not in mesh.to_pyvista().point_data
    assert mesh.to_trimesh().keywords["vertex_normals"] is None


class TensorMap(dict):
    def __setattr__(self, name, value):
        self[name] = value


class TriangleMesh:
    def __init__(self, vertices, triangles):
        self.vertex = TensorMap(positions=vertices)
        self.triangle = TensorMap(indices=triangles)


def check_open3d(made, mesh, to_numpy):
    assert np.array_equal(to_numpy(made.vertex["positions"]), mesh.vertices32)
    assert np.array_equal(to_numpy(made.triangle["indices"]), mesh.triangles)
    assert np.array_equal(to_numpy(made.vertex["normals"]), mesh.normals)
    assert np.array_equal(to_numpy(made.vertex["velocity"]), mesh.attributes["velocity"])
    for name in "id", "age":
        assert np.array_equal(to_numpy(made.vertex[name]).ravel(), mesh.attributes[name]), name
    assert np.array_equal(to_numpy(made.triangle["level"]).ravel(), mesh.levels)


def test_open3d_is_given_tensors_of_types_that_it_has(stand_in, carried):
    known = ("float32", "float64", "int32", "int64", "uint8")

    def tensor(array):
        assert array.dtype.name in known and array.ndim == 2 and array.flags.writeable
        return array

    made = types.SimpleNamespace(geometry=types.SimpleNamespace(TriangleMesh=TriangleMesh))
    stand_in("open3d", core=types.SimpleNamespace(Tensor=tensor), t=made)
    check_open3d(carried.to_open3d(), carried, np.asarray)


def test_the_real_open3d_finds_the_mesh_closed(carried):
    pytest.importorskip("open3d")
    made = carried.to_open3d()
    check_open3d(made, carried, lambda tensor: tensor.numpy())
    legacy = made.to_legacy()
    assert is_closed(np.asarray(legacy.triangles)) and legacy.is_orientable() and legacy.is_edge_manifold()
    assert legacy.get_volume() == pytest.approx(carried.volume, rel=1e-5)


PACKAGES = {"pyvista": "install pyvista", "trimesh": "install trimesh", "open3d": "install python3-open3d of Debian"}


@pytest.mark.parametrize("name", PACKAGES)
def test_a_library_that_is_not_there_is_named(name, mesh, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=f"there is no module {name} here: {PACKAGES[name]}"):
        getattr(mesh, f"to_{name}")()
