"""formats_exchange_test.py PROGRAM HDF5: files of meshio, numpy and h5py are read, and ours by them, Open3D and VTK.

PROGRAM: formats_exchange, which reads one file and writes another. HDF5: ON if it reads HDF5. VTK's readers are those
of PyVista.
"""

import base64
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree as xml
import zlib

import meshio
import numpy as np

program, hdf5 = sys.argv.pop(1), sys.argv.pop(1) == "ON"
try:
    import h5py
except ImportError:
    hdf5 = False
rng = np.random.default_rng(1)
count = 500
positions = rng.uniform(-10, 10, (count, 3))
arrays = {
    "velocity": rng.normal(size=(count, 3)).astype(np.float32),
    "age": rng.uniform(0, 1, count),
    "id": np.arange(count, dtype=np.int64)[::-1].copy(),
    "phase": rng.integers(0, 255, count).astype(np.uint8),
}
narrow = {"velocity": np.float32, "age": np.float32, "id": np.int32, "phase": np.uint8}


def vtp(path):
    """Points and point data of a VTP file of ours, by its XML and the base64 in it."""
    types = {"Float32": "<f4", "Float64": "<f8", "UInt8": "u1", "Int32": "<i4", "UInt32": "<u4", "Int64": "<i8"}
    file = xml.parse(path).getroot()
    out = {}
    for element in file.iter("DataArray"):
        text = element.text.strip()
        if file.get("compressor"):
            data = inflated(text)
        else:
            data = base64.b64decode(text, validate=True)
            assert int.from_bytes(data[:8], "little") == len(data) - 8
            data = data[8:]
        numbers = np.frombuffer(data, types[element.get("type")])
        components = int(element.get("NumberOfComponents", "1"))
        out[element.get("Name")] = numbers.reshape(-1, components) if components > 1 else numbers
    return out


def inflated(text):
    """An array by zlib: a header in base64, then its blocks, together another base64."""
    blocks = int.from_bytes(base64.b64decode(text[:12])[:8], "little")
    mark = -(-8 * (3 + blocks) // 3) * 4
    _, size, last, *compressed = np.frombuffer(base64.b64decode(text[:mark], validate=True), "<u8").tolist()
    data = base64.b64decode(text[mark:], validate=True)
    assert sum(compressed) == len(data)
    out, at = b"", 0
    for i, length in enumerate(compressed):
        block = zlib.decompress(data[at : at + length])
        assert len(block) == (last if last and i + 1 == blocks else size)
        out, at = out + block, at + length
    return out


class Exchange(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def convert(self, kind, source, target):
        subprocess.run([program, kind, self.path / source, self.path / target], check=True, cwd=self.path)
        return self.path / target

    def meshio_points(self):
        cells = [("vertex", np.arange(count).reshape(-1, 1))]
        return meshio.Mesh(positions, cells, point_data=dict(arrays))

    def expect_particles(self, source):
        """That our reader has everything: numpy reads the .npz that we write of it."""
        with np.load(self.convert("particles", source, "back.npz")) as back:
            np.testing.assert_array_equal(back["positions"], positions.astype(np.float32))
            for name, values in arrays.items():
                self.assertEqual(back[name].dtype, narrow[name], name)
                np.testing.assert_array_equal(back[name], values.astype(narrow[name]), err_msg=name)

    def test_vtu_of_meshio(self):
        for binary, compression in ((False, None), (True, None), (True, "zlib")):
            for header in ("UInt32", "UInt64"):
                with self.subTest(binary=binary, compression=compression, header=header):
                    meshio.vtu.write(
                        self.path / "a.vtu",
                        self.meshio_points(),
                        binary=binary,
                        compression=compression,
                        header_type=header,
                    )
                    self.expect_particles("a.vtu")

    def test_legacy_vtk_of_meshio(self):
        for version in ("4.2", "5.1"):
            for binary in (False, True):
                with self.subTest(version=version, binary=binary):
                    meshio.vtk.write(self.path / "a.vtk", self.meshio_points(), fmt_version=version, binary=binary)
                    self.expect_particles("a.vtk")

    def test_numpy_arrays(self):
        np.savez(self.path / "a.npz", positions=positions, time=1.0, **arrays)
        self.expect_particles("a.npz")
        np.savez_compressed(self.path / "a.npz", positions=np.asfortranarray(positions), **arrays)
        self.expect_particles("a.npz")
        x, y, z = positions.T
        u, v, w = arrays["velocity"].T
        others = {name: values for name, values in arrays.items() if name != "velocity"}
        np.savez_compressed(self.path / "a.npz", x=x, y=y, z=z, u=u, v=v, w=w, **others)
        self.expect_particles("a.npz")

    def test_npy(self):
        for order in ("C", "F"):
            np.save(self.path / "a.npy", np.array(positions, order=order))
            with np.load(self.convert("particles", "a.npy", "back.npz")) as back:
                np.testing.assert_array_equal(back["positions"], positions.astype(np.float32))

    def refusal(self, source):
        run = subprocess.run(
            [program, "particles", self.path / source, self.path / "refused.npz"], capture_output=True, text=True
        )
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        self.assertIn(source, run.stderr)
        return run.stderr

    def test_other_pickled_objects_are_refused(self):
        np.savez(self.path / "a.npz", positions=np.array([{"x": 1}], dtype=object))
        self.assertIn("holds pickled Python objects", self.refusal("a.npz"))
        np.savez(self.path / "a.npz", particles={"fluid": {"arrays": {"x": np.zeros(2)}}})
        self.assertIn("has no array 'y'", self.refusal("a.npz"))

    def pysph_arrays(self):
        x, y, z = positions.T
        u, v, w = arrays["velocity"].T
        others = {name: values for name, values in arrays.items() if name != "velocity"}
        return {"x": x, "y": y, "z": z, "u": u, "v": v, "w": w, **others}

    def test_npz_of_pysph(self):
        def kind(values):
            return {"arrays": values, "properties": {name: {"type": "double"} for name in values}, "constants": {}}

        wall = {axis: np.zeros(3) for axis in "xyz"}
        particles = {"fluid": kind(self.pysph_arrays()), "wall": kind(wall)}
        for save in (np.savez, np.savez_compressed):
            save(self.path / "a.npz", version=2, particles=particles, solver_data={"t": 0.5, "dt": 1e-3})
            self.expect_particles("a.npz")

    def write_hdf5(self, name, place, values):
        with h5py.File(self.path / name, "w") as file:
            group = file.create_group(place)
            for key, array in values.items():
                group.create_dataset(key, data=array)

    @unittest.skipUnless(hdf5, "without HDF5 or h5py")
    def test_hdf5_of_h5part_and_pysph(self):
        # Beside the program, or where the sources are: HDF5's library looks for a file of the image's name.
        (self.path / "meniscus").mkdir()
        for place in ("Step#0", "particles/fluid/arrays"):
            self.write_hdf5("a.h5", place, self.pysph_arrays())
            self.expect_particles("a.h5")
        with h5py.File(self.path / "a.hdf5", "w") as file:
            group = file.create_group("particles/water/arrays")
            for key, array in self.pysph_arrays().items():
                group.create_dataset(key, data=array, compression="gzip", shuffle=True, chunks=(64,))
        self.expect_particles("a.hdf5")

    @unittest.skipUnless(hdf5, "without HDF5 or h5py")
    def test_wrong_hdf5_is_refused(self):
        line = np.zeros(4)
        (self.path / "a.h5").write_text("no HDF5, but a text of some length")
        self.assertIn("not an HDF5 file", self.refusal("a.h5"))
        self.write_hdf5("a.h5", "Step#0", {"y": line, "z": line})
        self.assertIn("no particles", self.refusal("a.h5"))
        self.write_hdf5("a.h5", "Step#0", {"x": [b"a", b"b"], "y": line, "z": line})
        self.assertIn("dataset 'x' is no list of numbers", self.refusal("a.h5"))
        self.write_hdf5("a.h5", "Step#0", {"x": line, "y": line[:3], "z": line})
        self.assertIn("dataset 'y' has 3 numbers, x has 4", self.refusal("a.h5"))
        self.write_hdf5("a.h5", "Step#0", {"x": 1.0, "y": line, "z": line})
        self.assertIn("dataset 'x' is no list of numbers", self.refusal("a.h5"))
        self.write_hdf5("a.h5", "Step#0", {"x": line.reshape(2, 2), "y": line, "z": line})
        self.assertIn("dataset 'x' is no list of numbers", self.refusal("a.h5"))
        with h5py.File(self.path / "a.h5", "w") as file:
            for step in range(2):
                for axis in "xyz":
                    file[f"Step#{step}/{axis}"] = line
        self.assertIn("has particles in 2 places", self.refusal("a.h5"))
        whole = (self.path / "a.h5").read_bytes()
        for size in range(0, len(whole), 397):
            (self.path / "a.h5").write_bytes(whole[:size])
            self.refusal("a.h5")

    def test_an_npz_bomb_stops_at_what_it_announces(self):
        # 30 MB of zeros in 30 kB, of which the zip directory announces 200 bytes.
        np.savez_compressed(self.path / "a.npz", positions=np.zeros((2_500_000, 3), np.float32))
        data = bytearray((self.path / "a.npz").read_bytes())
        size = data.rindex(b"PK\1\2") + 24
        data[size : size + 4] = (200).to_bytes(4, "little")
        (self.path / "a.npz").write_bytes(data)
        self.assertIn("more than the 200 bytes", self.refusal("a.npz"))

    @unittest.skipUnless(hdf5, "without HDF5 or h5py")
    def test_an_hdf5_bomb_stops_at_what_it_announces(self):
        # Ten thousand million zeros, of which the file has none.
        with h5py.File(self.path / "a.h5", "w") as file:
            for axis in "xyz":
                file.create_dataset(f"Step#0/{axis}", (10**10,), "f4", chunks=(2**20,), compression="gzip")
        self.assertLess((self.path / "a.h5").stat().st_size, 10**6)
        self.assertIn("more than the file may take in memory", self.refusal("a.h5"))

    def test_our_particles(self):
        np.savez(self.path / "a.npz", positions=positions, **arrays)
        for name in ("b.vtk", "b.ply"):
            back = meshio.read(self.convert("particles", "a.npz", name))
            np.testing.assert_array_equal(back.points.astype(np.float32), positions.astype(np.float32))
            for array in ("age", "id", "phase"):
                # meshio takes the unsigned characters of legacy VTK for signed ones.
                values = back.point_data[array].astype(narrow[array])
                np.testing.assert_array_equal(values, arrays[array].astype(narrow[array]))
        velocity = meshio.read(self.path / "b.vtk").point_data["velocity"]
        np.testing.assert_array_equal(velocity, arrays["velocity"])
        back = vtp(self.convert("particles", "a.npz", "b.vtp"))
        np.testing.assert_array_equal(back["Points"], positions.astype(np.float32))
        np.testing.assert_array_equal(back["velocity"], arrays["velocity"])
        np.testing.assert_array_equal(back["offsets"], np.arange(1, count + 1))

    def mesh_file(self):
        triangles = rng.integers(0, count, (700, 3))
        levels = rng.integers(0, 4, 700).astype(np.uint8)
        np.savez(self.path / "m.npz", positions=positions, triangles=triangles, levels=levels, **arrays)
        return triangles, levels

    def test_our_meshes(self):
        triangles, levels = self.mesh_file()
        # meshio reads no levels of triangles in a binary PLY.
        back = meshio.read(self.convert("no-levels", "m.npz", "m.ply"))
        np.testing.assert_array_equal(back.points, positions)
        np.testing.assert_array_equal(back.cells_dict["triangle"], triangles)
        np.testing.assert_array_equal(back.point_data["id"], arrays["id"])
        np.testing.assert_array_equal(back.point_data["velocity_z"], arrays["velocity"][:, 2])
        for kind in ("mesh", "compressed"):
            with self.subTest(kind):
                back = vtp(self.convert(kind, "m.npz", "m.vtp"))
                np.testing.assert_array_equal(back["Points"], positions)
                np.testing.assert_array_equal(back["connectivity"].reshape(-1, 3), triangles)
                np.testing.assert_array_equal(back["level"], levels)
                np.testing.assert_array_equal(back["velocity"], arrays["velocity"])

    def test_our_vtu_in_meshio(self):
        triangles, levels = self.mesh_file()
        for kind in ("mesh", "compressed"):
            with self.subTest(kind):
                back = meshio.read(self.convert(kind, "m.npz", "m.vtu"))
                np.testing.assert_array_equal(back.points, positions)
                np.testing.assert_array_equal(back.cells_dict["triangle"], triangles)
                np.testing.assert_array_equal(back.cell_data["level"][0], levels)
                for name, values in arrays.items():
                    np.testing.assert_array_equal(back.point_data[name], values.astype(narrow[name]), err_msg=name)
        self.convert("no-levels", "m.npz", "m.vtu")
        self.assertNotIn("level", meshio.read(self.path / "m.vtu").cell_data)

    def corners(self, triangles):
        """The corners' places, in the order of the triangles, as float32."""
        return positions.astype(np.float32)[triangles].reshape(-1, 3)

    def test_our_stl_in_meshio(self):
        triangles, _ = self.mesh_file()
        back = meshio.read(self.convert("mesh", "m.npz", "m.stl"))
        # It merges corners that are equal.
        np.testing.assert_array_equal(back.points[back.cells_dict["triangle"]].reshape(-1, 3), self.corners(triangles))
        data = (self.path / "m.stl").read_bytes()
        self.assertEqual(len(data), 84 + 50 * len(triangles))
        rows = np.frombuffer(data[84:], np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]))
        a, b, c = np.moveaxis(positions[triangles], 1, 0)
        normals = np.cross(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        whole = lengths[:, 0] > 0
        np.testing.assert_allclose(rows["normal"][whole], (normals / lengths)[whole], atol=1e-6)
        self.assertFalse(rows["normal"][~whole].any())

    @unittest.skipUnless(importlib.util.find_spec("open3d"), "without Open3D (python3-open3d)")
    def test_our_meshes_in_open3d(self):
        import open3d

        triangles, _ = self.mesh_file()
        for kind, name in (("mesh", "m.ply"), ("no-levels", "m.ply"), ("mesh", "m.stl"), ("mesh", "m.obj")):
            with self.subTest(kind, name=name):
                back = open3d.io.read_triangle_mesh(str(self.convert(kind, "m.npz", name)))
                places = np.asarray(back.vertices)[np.asarray(back.triangles)].reshape(-1, 3)
                # Open3D rounds the decimals of OBJ in a way of its own.
                tolerance = 1e-6 if name == "m.obj" else 0.0
                np.testing.assert_allclose(places.astype(np.float32), self.corners(triangles), rtol=tolerance)

    @unittest.skipUnless(importlib.util.find_spec("vtkmodules"), "without VTK (python3-vtk9)")
    def test_our_meshes_in_vtk(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader
        from vtkmodules.vtkIOPLY import vtkPLYReader
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

        triangles, levels = self.mesh_file()
        readers = {
            "m.ply": vtkPLYReader,
            "m.stl": vtkSTLReader,
            "m.obj": vtkOBJReader,
            "m.vtk": vtkPolyDataReader,
            "m.vtp": vtkXMLPolyDataReader,
            "m.vtu": vtkXMLUnstructuredGridReader,
        }
        for kind, name in (*(("mesh", name) for name in readers), ("no-levels", "m.ply"), ("compressed", "m.vtu")):
            with self.subTest(kind, name=name):
                reader = readers[name]()
                reader.SetFileName(str(self.convert(kind, "m.npz", name)))
                if name == "m.stl":
                    reader.MergingOff()
                reader.Update()
                data = reader.GetOutput()
                cells = data.GetCells() if name == "m.vtu" else data.GetPolys()
                corners = vtk_to_numpy(cells.GetConnectivityArray())
                places = vtk_to_numpy(data.GetPoints().GetData())[corners]
                np.testing.assert_array_equal(places.astype(np.float32), self.corners(triangles))
                if name in ("m.vtk", "m.vtp", "m.vtu"):
                    np.testing.assert_array_equal(vtk_to_numpy(data.GetCellData().GetArray("level")), levels)
                    velocity = vtk_to_numpy(data.GetPointData().GetArray("velocity"))
                    np.testing.assert_array_equal(velocity, arrays["velocity"])

    def test_arrays_of_vtp_may_have_any_number_of_bytes(self):
        # Below, exactly and beyond base64's groups of three, the writer's piece and a compressed block.
        for points in (1, 2, 3, 4, 255, 256, 257, 3072, 3073, 100_000):
            values = rng.integers(0, 255, points).astype(np.uint8)
            np.savez(self.path / "n.npz", positions=rng.normal(size=(points, 3)), phase=values, triangles=[[0, 0, 0]])
            for kind in ("mesh", "compressed"):
                with self.subTest(kind, points=points):
                    path = self.convert(kind, "n.npz", "n.vtp")
                    np.testing.assert_array_equal(vtp(path)["phase"], values)
                    with np.load(self.convert("mesh", "n.vtp", "back.npz")) as back:
                        np.testing.assert_array_equal(back["phase"], values)

    def test_meshes_go_through_every_format(self):
        triangles, levels = self.mesh_file()
        source = "m.npz"
        for name in ("a.ply", "a.vtk", "a.vtp", "a.vtu", "a.npz"):
            self.convert("mesh", source, name)
            source = name
        with np.load(self.path / "a.npz") as back:
            np.testing.assert_array_equal(back["positions"], positions)
            np.testing.assert_array_equal(back["triangles"], triangles)
            np.testing.assert_array_equal(back["levels"], levels)
            for name, values in arrays.items():
                np.testing.assert_array_equal(back[name], values.astype(narrow[name]), err_msg=name)

    def test_our_glb(self):
        triangles, _ = self.mesh_file()
        data = self.convert("mesh", "m.npz", "m.glb").read_bytes()
        self.assertEqual(data[:4], b"glTF")
        self.assertEqual(int.from_bytes(data[8:12], "little"), len(data))
        size = int.from_bytes(data[12:16], "little")
        document = json.loads(data[20 : 20 + size])
        buffer = data[20 + size + 8 :]
        types = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
        columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

        def numbers(index):
            accessor = document["accessors"][index]
            view = document["bufferViews"][accessor["bufferView"]]
            dtype = np.dtype(types[accessor["componentType"]])
            width = columns[accessor["type"]]
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            step = view.get("byteStride", width * dtype.itemsize)
            rows = np.ndarray((accessor["count"], width), dtype, buffer, start, (step, dtype.itemsize))
            return rows[:, 0] if width == 1 else rows

        primitive = document["meshes"][0]["primitives"][0]
        np.testing.assert_array_equal(numbers(primitive["indices"]).reshape(-1, 3), triangles)
        middle = np.array(document["nodes"][0]["translation"])
        found = numbers(primitive["attributes"]["POSITION"]) + middle
        np.testing.assert_allclose(found, positions, atol=1e-6)
        np.testing.assert_array_equal(numbers(primitive["attributes"]["_VELOCITY"]), arrays["velocity"])
        np.testing.assert_array_equal(numbers(primitive["attributes"]["_ID"]), arrays["id"])

    def test_meshes_of_meshio(self):
        triangles = rng.integers(0, count, (50, 3))
        quads = rng.integers(0, count, (20, 4))
        mesh = meshio.Mesh(positions, [("triangle", triangles), ("quad", quads)])
        mesh.write(self.path / "a.vtk", file_format="vtk")
        with np.load(self.convert("mesh", "a.vtk", "a.npz")) as back:
            expected = np.concatenate([triangles, np.stack([quads[:, :3], quads[:, [0, 2, 3]]], axis=1).reshape(-1, 3)])
            np.testing.assert_array_equal(back["triangles"], expected)
            np.testing.assert_array_equal(back["positions"], positions)


unittest.main()
