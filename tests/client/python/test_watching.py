"""Views of a session that another program feeds: meshes, particles, snapshots and recordings."""

import threading
from datetime import timezone

import meniscus
import numpy as np
import pytest
from support.closedness import is_closed
from support.particles import ball, particle_radius
from test_server import refused


@pytest.fixture
def shown(session, positions):
    """A session with a frame, and a stream that is open."""
    carried = {"age": np.linspace(0, 1, len(positions)), "id": np.arange(len(positions))}
    with session.stream() as stream:
        stream.push(positions, attributes=carried, time=2.5)
        assert stream.next(60).index == 0
        yield session


def test_a_watcher_gets_the_newest_mesh(shown, client, mesh):
    with client.watch(shown.id) as watcher:
        frame = watcher.next(60)
        assert (frame.index, frame.time, frame.mesh.sha256()) == (0, 2.5, mesh.sha256())
        assert set(frame.mesh.attributes) == {"age", "id"} and frame.changed and frame.vanished == ()
        assert all(isinstance(number, int) for brick in frame.changed for number in brick)
        assert watcher.next(0) is None and watcher.next(0.01) is None and not watcher.ended


def test_a_watcher_says_why_its_session_ended(client):
    session = client.session(particle_radius=particle_radius)
    with session.watch() as watcher:
        assert watcher.end_reason == ""
        session.end()
        assert watcher.next(60) is None and watcher.ended
        assert watcher.end_reason == "it was deleted"


def test_bricks_that_change_are_named(client):
    with client.session(particle_radius=particle_radius) as session, session.stream() as stream:
        with session.watch() as watcher:
            near, far = ball(), ball(center=(5.0, 0, 0))
            stream.push(np.concatenate([near, far]))
            first = watcher.next(60)
            stream.push(near)
            second = watcher.next(60)
            assert set(second.vanished) < set(first.changed) and second.vanished
            assert set(second.changed).isdisjoint(second.vanished)
            stream.push([])
            assert len(watcher.next(60).mesh.triangles) == 0


def test_a_coarser_level_is_closed_and_smaller(shown, mesh):
    with shown.watch(max_level=1) as watcher:
        coarse = watcher.next(60).mesh
    assert coarse.levels.max() == 1 < mesh.levels.max()
    assert len(coarse.triangles) < len(mesh.triangles) and is_closed(coarse.triangles)


def test_a_watcher_has_its_own_options(shown, mesh):
    with shown.watch(normal_bits=0, attributes=[], position_bits=2) as watcher:
        frame = watcher.next(60)
        assert frame.mesh.normals is None and frame.mesh.attributes == {} and set(frame.attributes) == {"age", "id"}
        assert frame.mesh.offset_bits == 2 and is_closed(frame.mesh.triangles)
    with shown.watch(region=((100, 100, 100), (101, 101, 101)), viewpoint=(1, 2, 3)) as watcher:
        assert len(watcher.next(60).mesh.triangles) == 0
    with shown.watch(region=(-1, -1, -1, 1, 1, 1), bytes_per_second=10**9, attributes={"age": 0}) as watcher:
        frame = watcher.next(60)
        assert frame.mesh.sha256() == mesh.sha256() and set(frame.mesh.attributes) == {"age"}


def test_spray_comes_beside_the_surface(client, positions):
    lone = np.array([[3.0, 3.0, 3.0]], np.float32)
    with client.session(particle_radius=particle_radius, spray="points") as session:
        with session.watch(spray=True) as watcher, session.stream(spray=True) as stream:
            stream.push(np.concatenate([positions, lone]))
            for frame in stream.next(60), watcher.next(60):
                assert np.array_equal(frame.spray, lone) and frame.statistics.spray_particles == 1


def test_a_watcher_of_particles_gets_them_rounded(shown, positions):
    with shown.watch_particles() as watcher:
        frame = watcher.next(60)
    assert (frame.index, frame.time, frame.frame_count, frame.stride) == (0, 2.5, len(positions), 1)
    assert frame.particle_radius == particle_radius and frame.levels is None
    assert frame.positions.dtype == np.float32 and frame.positions.shape == positions.shape
    assert np.abs(frame.positions - positions).max() <= 1.0 / 65535
    assert repr(frame) == f"<meniscus.ParticleFrame 0: every 1 of {len(positions)} particles>"


def test_a_watcher_of_particles_gets_every_kth(shown, client, positions):
    with client.watch_particles(shown.id, max_particles=100) as watcher:
        frame = watcher.next(60)
    assert frame.stride == -(-len(positions) // 100) and len(frame.positions) <= 100
    assert np.abs(frame.positions - positions[:: frame.stride]).max() <= 1.0 / 65535


def test_a_watcher_of_particles_gets_their_levels(client, positions):
    level = np.arange(len(positions)) % 2
    with client.session(particle_radius=particle_radius) as session, session.watch_particles() as watcher:
        with session.stream() as stream:
            stream.push(positions, levels=level)
        assert np.array_equal(watcher.next(60).levels, level)


def test_received_arrays_outlive_their_frames(shown):
    with shown.watch() as watcher, shown.watch_particles() as particles:
        frame, places = watcher.next(60), particles.next(60)
        mesh = frame.mesh
        kept = [mesh.triangles, mesh.normals, mesh.lattice, mesh.attributes["id"], places.positions]
    copies = [array.copy() for array in kept]
    del frame, mesh, places, watcher, particles
    for _ in range(3):
        meniscus.reconstruct(ball(), particle_radius)
    assert all(np.array_equal(one, other) for one, other in zip(kept, copies))
    assert not any(one.flags.writeable for one in kept[:4])


def test_a_snapshot_is_the_newest_mesh(session, client, positions, mesh):
    assert client.snapshot(session.id) is None
    with session.stream() as stream:
        stream.push(positions, attributes={"age": np.ones(len(positions))})
        assert stream.next(60).index == 0
        frame = client.snapshot(session.id)
        assert frame.mesh.sha256() == mesh.sha256() and (frame.mesh.attributes["age"] == 1).all()
        coarse = client.snapshot(session.id, max_level=1, normal_bits=0, attributes=[])
        assert len(coarse.mesh.triangles) < len(mesh.triangles)
        assert coarse.mesh.normals is None and coarse.mesh.attributes == {}


@pytest.mark.parametrize("codec", ["packed", "entropy", "draco", None])
def test_the_codec_changes_no_mesh(shown, client, codec):
    expected = client.snapshot(shown.id, codec="draco").mesh.sha256()
    assert client.snapshot(shown.id, codec=codec).mesh.sha256() == expected
    with shown.watch(codec=codec) as watcher:
        assert watcher.next(60).mesh.sha256() == expected


def test_normals_can_be_the_receivers_own(shown, client):
    sent = client.snapshot(shown.id).mesh
    own = client.snapshot(shown.id, normals_by="receiver").mesh
    assert own.sha256() == sent.sha256() and own.normals.shape == sent.normals.shape
    assert np.allclose(np.linalg.norm(own.normals, axis=1), 1)
    # Of the same surface, but not the same numbers.
    assert np.median((own.normals * sent.normals).sum(axis=1)) > 0.9
    assert not np.array_equal(own.normals, sent.normals)
    with shown.watch(normals_by="receiver") as watcher:
        assert np.array_equal(watcher.next(60).mesh.normals, own.normals)


def test_a_recording_has_the_frames_of_its_session(session, client, positions):
    count = 4
    with session.stream() as stream:
        for i in range(count):
            stream.push(positions * (1 + 0.1 * i), time=0.5 * i)
        received = [stream.next(60).mesh.sha256() for _ in range(count)]
    session.end()
    with client.read_recording(session.id, 1) as reader:
        frames = list(reader)
        assert reader.ended and reader.next() is None
    assert [frame.mesh.sha256() for frame in frames] == received
    assert [frame.time for frame in frames] == [0, 0.5, 1, 1.5]
    with client.read_recording(session.id, 1, normals_by="receiver") as reader:
        assert not np.array_equal(reader.next(60).mesh.normals, frames[0].mesh.normals)
    with client.read_recording(session.id, 1, position=1, count=2) as reader:
        assert [frame.index for frame in reader] == [1, 2]
    (info,) = [listed for listed in client.recordings() if listed.session_id == session.id]
    assert (info.number, info.frames, info.first_frame_index, info.last_frame_index) == (1, count, 0, count - 1)
    assert info.bytes > 0 and not info.damaged and info.started_at.tzinfo == timezone.utc
    client.delete_recording(session.id, 1)
    with refused("not_found"):
        client.delete_recording(session.id, 1)


def test_a_server_that_records_nothing_says_so(own_server):
    with meniscus.Client(own_server().address) as client, refused("unimplemented", "UNIMPLEMENTED"):
        client.recordings()


def test_watchers_beyond_the_limit_are_refused(own_server):
    server = own_server("--max-watchers", 1)
    with meniscus.Client(server.address) as client, client.session(particle_radius=1.0) as session:
        with session.watch(), pytest.raises(meniscus.LimitExceeded, match="1"):
            session.watch().next(60)


@pytest.mark.parametrize("kind", ["watch", "watch_particles"])
def test_a_watcher_ends_by_cancel_from_another_thread(kind, session):
    watcher = getattr(session, kind)()
    found = []
    waiting = threading.Thread(target=lambda: found.append(watcher.next()))
    waiting.start()
    watcher.cancel()
    waiting.join(60)
    assert found == [None] and watcher.ended
    watcher.close()
    assert watcher.next() is None and list(watcher) == []
