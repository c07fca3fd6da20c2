"""A package that was built without the service: what needs a server says so, and the rest is there."""

import pickle

import meniscus
import numpy as np
import pytest
from support import meniscusd
from support.particles import particle_radius

pytestmark = pytest.mark.skipif(meniscusd.program != "", reason="this build has the service")


@pytest.mark.parametrize(
    "call",
    [
        lambda: meniscus.Client("127.0.0.1:50051"),
        lambda: meniscus.read_bricks("a.bricks"),
        lambda: meniscus.RecordingFile("a.recording"),
        lambda: meniscus.publish([], "site"),
    ],
)
def test_what_needs_it_says_how_the_package_was_built(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(meniscus.Error, match="without the service: build it without -DMENISCUS_SERVICE=OFF"):
        call()


def test_parts_go_to_a_session_by_a_program_of_another_build(tmp_path, monkeypatch):
    pytest.importorskip("mpi4py")
    mpi = pytest.importorskip("meniscus.mpi")
    monkeypatch.delenv("MENISCUS_PROGRAM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(meniscus.Error, match="rank 0: publishing parts of frames to a session is not in this build"):
        mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, server="127.0.0.1:50051")


def test_bricks_are_not_written_without_it(tmp_path):
    # What encodes them is asked first, and may be missing, too.
    with pytest.raises(
        meniscus.Error, match="is not in this build of Meniscus, which was made without (the service|Draco): "
    ):
        meniscus.reconstruct([[0, 0, 0]], particle_radius).save(tmp_path / "a.bricks")


def test_a_mesh_travels_between_processes(positions, mesh):
    again = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(again.triangles, mesh.triangles)
    assert np.array_equal(again.vertices, mesh.vertices)


@pytest.mark.parametrize("extension", [".ply", ".obj", ".vtk", ".vtp", ".vtu", ".stl", ".usda"])
def test_a_mesh_is_saved(extension, mesh, tmp_path):
    mesh.save(tmp_path / f"mesh{extension}")
    assert (tmp_path / f"mesh{extension}").stat().st_size > 100


def test_particles_are_read_back(positions, tmp_path):
    np.save(tmp_path / "frame.npy", positions)
    assert np.array_equal(meniscus.read_particles(tmp_path / "frame.npy").positions, positions)
