"""Particles from files."""

import json
import os
import struct

import meniscus
import numpy as np
import pytest
from support import command_line
from support.particles import particle_radius

READ = (".vtk", ".vtu", ".vtp", ".ply", ".npy", ".npz", ".bgeo", ".bgeo.gz", ".h5", ".hdf5", ".h5part", ".json")
READ += (".bi4", ".xyz", ".bin", ".raw")


@pytest.fixture
def carried(positions):
    return {"velocity": positions * 3, "id": np.arange(len(positions), dtype=np.int32)}


@pytest.fixture
def file(positions, carried, tmp_path):
    np.savez(tmp_path / "particles.npz", positions=positions, levels=np.zeros(len(positions), np.uint8), **carried)
    return tmp_path / "particles.npz"


def test_extensions_are_told():
    extensions = set(meniscus.particle_extensions())
    assert extensions <= set(READ) and extensions >= set(READ) - {".h5", ".hdf5", ".h5part"}


def test_a_file_has_positions_levels_and_attributes(file, positions, carried):
    particles = meniscus.read_particles(file)
    assert np.array_equal(particles.positions, positions) and particles.positions.dtype == np.float32
    assert particles.levels.dtype == np.uint8 and particles.levels.shape == (len(positions),)
    assert len(particles) == len(positions)
    assert set(particles.attributes) == set(carried) and particles.left_out == ()
    for name, values in carried.items():
        assert np.array_equal(particles.attributes[name], values)
        assert particles.attributes[name].dtype == values.dtype
    assert meniscus.reconstruct(particles.positions, particle_radius, attributes=particles.attributes).attributes


@pytest.mark.parametrize("extension", [".ply", ".vtk", ".vtp", ".npz"])
def test_what_the_command_line_writes_is_read(extension, file, positions, carried, tmp_path):
    command_line.meniscus("convert", file, "-o", tmp_path / f"copy{extension}", "--particles")
    particles = meniscus.read_particles(os.fspath(tmp_path / f"copy{extension}"))
    assert np.array_equal(particles.positions, positions)
    for name, values in carried.items():
        assert np.array_equal(particles.attributes[name], values)


def test_raw_triples_and_lists_are_read(positions, tmp_path):
    for name in "p.xyz", "p.bin", "p.raw":
        positions.tofile(tmp_path / name)
    np.save(tmp_path / "p.npy", positions.astype(np.float64))
    (tmp_path / "p.json").write_text(json.dumps(positions.astype(float).tolist()))
    for name in "p.xyz", "p.bin", "p.raw", "p.npy", "p.json":
        particles = meniscus.read_particles(tmp_path / name)
        assert np.array_equal(particles.positions, positions), name
        assert particles.levels is None and particles.attributes == {}


def test_hdf5_is_read_where_the_build_has_it(positions, tmp_path):
    if ".h5" not in meniscus.particle_extensions():
        pytest.skip("this build has no HDF5")
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "p.h5", "w") as written:
        step = written.create_group("Step#0")
        for axis, column in zip("xyz", positions.T):
            step[axis] = column
    assert np.array_equal(meniscus.read_particles(tmp_path / "p.h5").positions, positions)


def test_hdf5_that_leads_to_other_files_is_refused(positions, tmp_path):
    if ".h5" not in meniscus.particle_extensions():
        pytest.skip("this build has no HDF5")
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "other.h5", "w") as other:
        other["positions"] = positions.astype("<f4")
    positions.astype("<f4").tofile(tmp_path / "raw")
    for way in "storage", "link", "virtual":
        with h5py.File(tmp_path / "p.h5", "w") as written:
            if way == "storage":
                storage = [(os.fsencode(tmp_path / "raw"), 0, positions.size * 4)]
                written.create_dataset("positions", positions.shape, "<f4", external=storage)
            elif way == "link":
                written["positions"] = h5py.ExternalLink(tmp_path / "other.h5", "/positions")
            else:
                layout = h5py.VirtualLayout(positions.shape, "<f4")
                layout[:] = h5py.VirtualSource(tmp_path / "other.h5", "positions", positions.shape)
                written.create_virtual_dataset("positions", layout)
        with pytest.raises(meniscus.InvalidInput, match="in another file"):
            meniscus.read_particles(tmp_path / "p.h5")


def test_what_has_no_place_is_told(positions, tmp_path):
    np.savez(tmp_path / "p.npz", positions=positions, tensor=np.zeros((len(positions), 9), np.float32))
    particles = meniscus.read_particles(tmp_path / "p.npz")
    assert particles.attributes == {}
    assert len(particles.left_out) == 1 and "tensor" in particles.left_out[0]


def test_a_mesh_that_is_read_as_particles_is_warned_of_as_in_the_command_line(mesh, tmp_path):
    mesh.save(tmp_path / "mesh.ply")
    with pytest.warns(meniscus.SurfaceWarning) as warned:
        assert len(meniscus.read_particles(tmp_path / "mesh.ply")) == len(mesh.vertices)
    text = f"the file has {len(mesh.triangles)} faces, so that it is a mesh: its {len(mesh.vertices)} corners are taken"
    assert [str(one.message) for one in warned] == [f"{tmp_path / 'mesh.ply'}: {text} as particles"]
    assert warned[0].filename == __file__
    printed = command_line.said_beside("reconstruct", tmp_path / "mesh.ply", "-o", tmp_path / "o.ply", "-r", 0.05)
    assert str(warned[0].message) in printed


@pytest.mark.parametrize(
    "pattern, one",
    [
        ("frame_*.vtk", "frame_{number}.vtk"),
        ("frame_%04d.vtk", "frame_{number:04}.vtk"),
        ("frame_%d.vtk", "frame_{number}.vtk"),
        ("frame_####.vtk", "frame_{number:04}.vtk"),
    ],
)
def test_a_pattern_of_files_is_answered_by_the_file_of_a_number(pattern, one, tmp_path):
    with pytest.raises(meniscus.InvalidInput) as raised:
        meniscus.read_particles(tmp_path / pattern)
    advice = f"; a call reads one file: write f'{tmp_path / one}' in a loop over the numbers"
    assert "no such file" in str(raised.value) and str(raised.value).endswith(advice)


def test_a_file_with_a_star_in_its_name_is_read(positions, tmp_path):
    np.save(tmp_path / "a*b.npy", positions)
    assert len(meniscus.read_particles(tmp_path / "a*b.npy")) == len(positions)


def test_arrays_outlive_the_particles_and_can_be_written_to(file, positions):
    read = meniscus.read_particles(file)
    places, velocity = read.positions, read.attributes["velocity"]
    del read
    for _ in range(3):
        meniscus.read_particles(file)
    assert np.array_equal(places, positions) and np.array_equal(velocity, positions * 3)


def test_a_larger_file_than_allowed_is_refused(file):
    with pytest.raises(meniscus.LimitExceeded, match="100"):
        meniscus.read_particles(file, max_bytes=100)


REAL = {
    "double_dam_break_with_sphere/frame_040.vtk": (11492, {"id", "velocity"}),
    "single_frames/free_particles_1000_particles.vtk": (1000, None),
    "single_frames/cube_8_particles.vtk": (8, None),
    "single_frames/cube_8_particles.vtu": (8, None),
    "single_frames/fluid_250_particles.vtu": (250, None),
    "single_frames/dam_break_frame_23_24389_particles.bgeo": (24389, None),
}


@pytest.mark.parametrize("name", REAL)
def test_real_frames_are_read(name):
    path = os.path.join(os.environ.get("MENISCUS_DATA", ""), name)
    if not os.path.exists(path):
        pytest.skip(f"MENISCUS_DATA has no {name}")
    particles = meniscus.read_particles(path)
    count, names = REAL[name]
    assert len(particles) == count and np.isfinite(particles.positions).all()
    assert names is None or set(particles.attributes) == names


def test_damaged_files_are_refused_and_never_crash(file, tmp_path):
    whole = file.read_bytes()
    rng = np.random.default_rng(11)
    refused = 0
    for i in range(60):
        damaged = bytearray(whole)
        for place in rng.integers(0, len(damaged), 8):
            damaged[place] = rng.integers(0, 256)
        (tmp_path / "damaged.npz").write_bytes(bytes(damaged[: rng.integers(1, len(damaged))] if i % 2 else damaged))
        try:
            meniscus.read_particles(tmp_path / "damaged.npz")
        except meniscus.InvalidInput as error:
            assert "damaged.npz" in str(error) and "\n" not in str(error)
            refused += 1
    assert refused > 20


def test_a_header_that_promises_too_much_takes_no_memory(tmp_path):
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (1000000000000, 3), }"
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    (tmp_path / "p.npy").write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header)
    with pytest.raises((meniscus.InvalidInput, meniscus.LimitExceeded), match="p.npy"):
        meniscus.read_particles(tmp_path / "p.npy")
