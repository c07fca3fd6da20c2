"""formats_exchange_test.py PROGRAM: files that meshio and numpy write are read, and ours are read by them.

PROGRAM: formats_exchange, which reads one file and writes another.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree as xml

import meshio
import numpy as np

program = sys.argv.pop(1)
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
    """Points and point data of a VTP file of ours, by its XML and the bytes behind the underscore."""
    data = path.read_bytes()
    mark = data.index(b"<AppendedData")
    begin = data.index(b"_", mark) + 1
    root = xml.fromstring(data[:mark] + b"</VTKFile>")
    types = {"Float32": "<f4", "Float64": "<f8", "UInt8": "u1", "Int32": "<i4", "UInt32": "<u4", "Int64": "<i8"}
    out = {}
    for element in root.iter("DataArray"):
        at = begin + int(element.get("offset"))
        size = int.from_bytes(data[at : at + 8], "little")
        numbers = np.frombuffer(data[at + 8 : at + 8 + size], types[element.get("type")])
        components = int(element.get("NumberOfComponents"))
        out[element.get("Name")] = numbers.reshape(-1, components) if components > 1 else numbers
    return out


class Exchange(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def convert(self, kind, source, target):
        subprocess.run([program, kind, self.path / source, self.path / target], check=True)
        return self.path / target

    def meshio_points(self):
        cells = [("vertex", np.arange(count).reshape(-1, 1))]
        return meshio.Mesh(positions, cells, point_data=dict(arrays))

    def expect_particles(self, source):
        """That our reader has everything, told by numpy of the .npz that we write of it."""
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

    def test_pickled_objects_are_refused(self):
        np.savez(self.path / "a.npz", particles=np.array([{"x": 1}], dtype=object))
        run = subprocess.run(
            [program, "particles", self.path / "a.npz", self.path / "b.npz"], capture_output=True, text=True
        )
        self.assertEqual(run.returncode, 1)
        self.assertIn("holds pickled Python objects", run.stderr)

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
        np.savez(self.path / "plain.npz", positions=positions, triangles=triangles, **arrays)
        back = meshio.read(self.convert("mesh", "plain.npz", "m.ply"))
        np.testing.assert_array_equal(back.points, positions)
        np.testing.assert_array_equal(back.cells_dict["triangle"], triangles)
        np.testing.assert_array_equal(back.point_data["id"], arrays["id"])
        np.testing.assert_array_equal(back.point_data["velocity_z"], arrays["velocity"][:, 2])
        back = vtp(self.convert("mesh", "m.npz", "m.vtp"))
        np.testing.assert_array_equal(back["Points"], positions)
        np.testing.assert_array_equal(back["connectivity"].reshape(-1, 3), triangles)
        np.testing.assert_array_equal(back["level"], levels)
        np.testing.assert_array_equal(back["velocity"], arrays["velocity"])

    def test_meshes_go_through_every_format(self):
        triangles, levels = self.mesh_file()
        source = "m.npz"
        for name in ("a.ply", "a.vtk", "a.vtp", "a.npz"):
            self.convert("mesh", source, name)
            source = name
        with np.load(self.path / "a.npz") as back:
            np.testing.assert_array_equal(back["positions"], positions)
            np.testing.assert_array_equal(back["triangles"], triangles)
            np.testing.assert_array_equal(back["levels"], levels)
            for name, values in arrays.items():
                np.testing.assert_array_equal(back[name], values.astype(narrow[name]), err_msg=name)

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
