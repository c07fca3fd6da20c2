"""Surfaces on this disk: files of bricks, and recordings of a server."""

import glob
import os
import threading

import meniscus
import numpy as np
import pytest
from support.particles import particle_radius


@pytest.fixture
def recorded(own_server, socket_folder, positions):
    """A recording of three frames, and their meshes as they came."""
    server = own_server("--record", f"{socket_folder}/recordings")
    with meniscus.Client(server.address) as client, client.session(particle_radius, name="dam") as session:
        with session.stream() as stream:
            for step in range(3):
                stream.push(positions[step:], time=1 + 0.5 * step, index=2 * step)
        frames = list(stream)
    server.stop()
    (path,) = glob.glob(f"{socket_folder}/recordings/{session.id}/*.recording")
    return meniscus.RecordingFile(path), session.id, frames


def test_a_recording_has_its_frames(recorded):
    file, session_id, frames = recorded
    assert (file.session_id, file.name, file.cut_bytes, len(file)) == (session_id, "dam", 0, 3)
    assert file.times == (1.0, 1.5, 2.0) and file.indices == (0, 2, 4)
    assert file.settings["particle_radius"] == particle_radius
    for read, received in zip(file, frames):
        assert (read.index, read.time) == (received.index, received.time)
        assert read.mesh.sha256() == received.mesh.sha256()
        assert read.statistics.particles == received.statistics.particles
    assert meniscus.Reconstructor(**file.settings).settings == file.settings


def test_a_place_that_is_not_there_is_refused(recorded):
    file, _, _ = recorded
    for place in -1, 3, 1 << 70:
        with pytest.raises(meniscus.InvalidInput, match=f"no frame at the place {place}, but at 0 to 2"):
            file.frame(place)


def test_a_cut_recording_has_the_frames_before(recorded, tmp_path):
    file, _, frames = recorded
    with open(file.path, "rb") as whole:
        (tmp_path / "cut.recording").write_bytes(whole.read()[:-100])
    cut = meniscus.RecordingFile(tmp_path / "cut.recording")
    assert len(cut) == 2 and cut.cut_bytes > 0
    assert cut.frame(1).mesh.sha256() == frames[1].mesh.sha256()


def test_threads_read_one_recording(recorded):
    file, _, frames = recorded
    read = {}

    def work(thread):
        read[thread] = [file.frame((place + thread) % 3).mesh.sha256() for place in range(12)]

    threads = [threading.Thread(target=work, args=(thread,)) for thread in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    for thread, hashes in read.items():
        assert hashes == [frames[(place + thread) % 3].mesh.sha256() for place in range(12)]
    assert len(read) == 4


def test_bricks_are_read_as_they_were_saved(mesh, tmp_path):
    mesh.save(tmp_path / "m.bricks")
    frame = meniscus.read_bricks(tmp_path / "m.bricks")
    assert frame.mesh.sha256() == mesh.sha256()
    assert np.array_equal(frame.mesh.levels, mesh.levels)


@pytest.mark.parametrize("read", [meniscus.read_bricks, meniscus.RecordingFile])
def test_other_files_are_refused_by_name(read, mesh, tmp_path):
    (tmp_path / "text").write_text("neither bricks nor a recording, but a text of some length")
    mesh.save(tmp_path / "m.ply")
    for name in "text", "m.ply", "gone", ".":
        with pytest.raises(meniscus.InvalidInput) as refused:
            read(tmp_path / name)
        assert str(tmp_path) in str(refused.value)
    with pytest.raises(TypeError):
        read(7)


def test_a_larger_file_than_is_allowed_is_refused(mesh, tmp_path):
    mesh.save(tmp_path / "m.bricks")
    with pytest.raises(meniscus.LimitExceeded, match="at most 100 are read: give max_bytes"):
        meniscus.read_bricks(tmp_path / "m.bricks", max_bytes=100)
    for wrong in -1, 1e9:
        with pytest.raises(meniscus.InvalidInput, match=f"max_bytes is {wrong}, must be a whole number"):
            meniscus.read_bricks(tmp_path / "m.bricks", max_bytes=wrong)


@pytest.mark.parametrize("read", [meniscus.read_bricks, meniscus.RecordingFile])
def test_a_path_is_taken_whole(read, mesh, tmp_path):
    mesh.save(tmp_path / "m.bricks")
    with pytest.raises(meniscus.InvalidInput, match="has a zero byte"):
        read(f"{tmp_path}/m.bricks\0.old")
    odd = os.fsdecode(os.fsencode(tmp_path) + b"/\xff.bricks")
    with pytest.raises(meniscus.InvalidInput, match=r"\\xff.bricks: "):
        read(odd)


def test_bricks_may_have_any_name(mesh, tmp_path):
    odd = os.fsdecode(os.fsencode(tmp_path) + b"/\xff.bricks")
    mesh.save(odd)
    assert meniscus.read_bricks(odd).mesh.sha256() == mesh.sha256()
