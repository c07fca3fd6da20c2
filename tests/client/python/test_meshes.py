"""Meshes as Python objects: the owner of their memory, and files."""

import gc
import os
import weakref

import meniscus
import numpy as np
import pytest
from support import command_line
from support.particles import ball, particle_radius

EXTENSIONS = (".ply", ".obj", ".vtk", ".vtp", ".vtu", ".npz", ".glb", ".usda", ".stl", ".bricks")


def arrays_of(mesh):
    return {
        "vertices": mesh.vertices,
        "vertices32": mesh.vertices32,
        "lattice": mesh.lattice,
        "triangles": mesh.triangles,
        "normals": mesh.normals,
        "levels": mesh.levels,
        "spray": mesh.spray,
        **mesh.attributes,
    }


@pytest.fixture
def carried(positions):
    return {"velocity": positions * 3, "id": np.arange(len(positions), dtype=np.int32)}


def test_arrays_outlive_the_mesh_and_its_reconstructor(positions, carried):
    reconstructor = meniscus.Reconstructor(particle_radius)
    mesh = reconstructor.reconstruct(positions, attributes=carried)
    views = arrays_of(mesh)
    copies = {name: view.copy() for name, view in views.items()}
    gone = weakref.ref(mesh)
    del mesh, reconstructor
    gc.collect()
    assert gone() is None
    # These meshes would overwrite memory that was freed too early.
    for i in range(5):
        meniscus.reconstruct(ball(0.3 + 0.05 * i), particle_radius)
    for name, view in views.items():
        assert np.array_equal(view, copies[name]), name


def test_a_later_frame_does_not_touch_an_earlier_mesh(positions, carried):
    reconstructor = meniscus.Reconstructor(particle_radius)
    kept = []
    for i in range(6):
        mesh = reconstructor.reconstruct(positions * (1 + 0.01 * i), attributes=carried)
        kept.append((arrays_of(mesh), {name: view.copy() for name, view in arrays_of(mesh).items()}))
        if i % 2:
            kept.pop()
        del mesh
    for views, copies in kept:
        for name, view in views.items():
            assert np.array_equal(view, copies[name]), name


def test_a_view_of_a_view_keeps_the_memory(positions):
    reconstructor = meniscus.Reconstructor(particle_radius)
    corner = reconstructor.reconstruct(positions).triangles[5:6, :2].T
    expected = corner.copy()
    gc.collect()
    for i in range(3):
        reconstructor.reconstruct(positions * (1 + 0.1 * i))
    assert np.array_equal(corner, expected)


def test_memory_of_meshes_that_are_gone_is_used_again(positions):
    reconstructor = meniscus.Reconstructor(particle_radius)
    for _ in range(4):
        mesh = reconstructor.reconstruct(positions)
        allocations = mesh.statistics.allocations
        del mesh
    assert allocations == 0


def test_arrays_are_read_only(positions, carried):
    mesh = meniscus.reconstruct(positions, particle_radius, attributes=carried)
    for name, view in arrays_of(mesh).items():
        with pytest.raises(ValueError, match="read-only"):
            view[...] = 0
        for make_writable in view.setflags, view[1:].setflags, view.view().setflags:
            with pytest.raises(ValueError, match="WRITEABLE"):
                make_writable(write=True)


def test_views_cost_no_copy(positions, carried):
    mesh = meniscus.reconstruct(positions, particle_radius, attributes=carried)
    for name in ("lattice", "triangles", "normals"):
        assert np.shares_memory(getattr(mesh, name), getattr(mesh, name)), name
    assert mesh.attributes["velocity"] is mesh.attributes["velocity"]
    assert mesh.vertices is mesh.vertices


def test_a_mesh_has_a_statement_of_all_extensions():
    assert set(meniscus.mesh_extensions()) == set(EXTENSIONS)


@pytest.mark.parametrize("extension", EXTENSIONS)
def test_files_are_those_of_the_command_line_to_the_byte(extension, positions, carried, tmp_path):
    np.savez(tmp_path / "particles.npz", positions=positions, **carried)
    codec = ["--codec", "draco"] if extension == ".bricks" else []  # which a mesh of the package's own has
    figures = command_line.reconstructed(
        tmp_path / "particles.npz", tmp_path / f"expected{extension}", particle_radius, "--attribute", "all", *codec
    )
    mesh = meniscus.reconstruct(positions, particle_radius, attributes=carried)
    assert mesh.sha256() == figures["mesh_sha256"]
    assert mesh.bricks_sha256() == figures["bricks_sha256"]
    mesh.save(tmp_path / f"found{extension}")
    mesh.save(os.fspath(tmp_path / f"as_text{extension}"))
    # At the end of .bricks are the frame's figures, with the times that it took.
    end = -200 if extension == ".bricks" else None
    expected = (tmp_path / f"expected{extension}").read_bytes()[:end]
    assert len(expected) > 1000
    assert (tmp_path / f"found{extension}").read_bytes()[:end] == expected
    assert (tmp_path / f"as_text{extension}").read_bytes()[:end] == expected


@pytest.mark.parametrize("preset", ["smooth", "paper", "splashsurf"])
def test_the_mesh_is_that_of_the_command_line(preset, tmp_path):
    rng = np.random.default_rng(5)
    particles = rng.random((3000, 3), dtype=np.float32) * 2 - 1
    levels = rng.integers(0, 2, len(particles)).astype(np.uint8)
    np.savez(tmp_path / "particles.npz", positions=particles, levels=levels)
    figures = command_line.reconstructed(
        tmp_path / "particles.npz", tmp_path / "mesh.ply", particle_radius, "--preset", preset
    )
    assert meniscus.reconstruct(particles, particle_radius, levels=levels, preset=preset).sha256() == (
        figures["mesh_sha256"]
    )


def test_a_received_mesh_is_saved_to_the_same_bytes(session, positions, carried, tmp_path):
    meniscus.reconstruct(positions, particle_radius, normals=False, attributes=carried).save(tmp_path / "here.ply")
    with session.stream(normal_bits=0, attribute_bits=0) as stream:
        stream.push(positions, attributes=carried)
        stream.next(60).mesh.save(tmp_path / "there.ply")
    assert (tmp_path / "there.ply").read_bytes() == (tmp_path / "here.ply").read_bytes()


def test_a_file_that_cannot_be_written_leaves_the_old_one(mesh, tmp_path):
    with pytest.raises(meniscus.InvalidInput, match=r"nowhere"):
        mesh.save(tmp_path / "nowhere" / "mesh.ply")
    old = tmp_path / "mesh.docx"
    old.write_text("old")
    with pytest.raises(meniscus.InvalidInput, match=r"\.docx"):
        mesh.save(old)
    assert old.read_text() == "old" and os.listdir(tmp_path) == ["mesh.docx"]


def test_a_real_frame_has_the_mesh_of_the_command_line(tmp_path):
    data = os.environ.get("MENISCUS_DATA", "")
    frame = os.path.join(data, "double_dam_break_with_sphere", "frame_040.vtk")
    if not os.path.exists(frame):
        pytest.skip("MENISCUS_DATA has no frame_040.vtk")
    figures = command_line.reconstructed(frame, tmp_path / "mesh.ply", 0.025)
    particles = meniscus.read_particles(frame)
    mesh = meniscus.reconstruct(particles.positions, 0.025, attributes=particles.attributes)
    assert mesh.sha256() == figures["mesh_sha256"]
    assert set(mesh.attributes) == {"id", "velocity"}
