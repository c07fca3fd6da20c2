"""Sessions, streams, watchers and snapshots of a real server, and what it refuses."""

import threading
import uuid
from datetime import datetime, timedelta, timezone

import meniscus
import numpy as np
import pytest
from support.closedness import is_closed
from support.particles import ball, particle_radius


def refused(code, status=None):
    """The block raises ServerError with this code."""

    class Check:
        def __enter__(self):
            self.raises = pytest.raises(meniscus.ServerError)
            self.caught = self.raises.__enter__()
            return self.caught

        def __exit__(self, *raised):
            done = self.raises.__exit__(*raised)
            assert self.caught.value.code == code, self.caught.value
            assert status is None or self.caught.value.status == status
            return done

    return Check()


def wait_for_the_end(source):
    """Waits for the end of a session, which a watcher notices by an error or by the end of its frames."""
    try:
        while source.next(60) is not None:
            pass
        assert source.ended
    except meniscus.ServerError as error:
        assert error.code in ("not_found", "canceled", "aborted", "unavailable"), error


def test_the_server_describes_itself(server, client):
    info = client.info()
    assert info.version == meniscus.__version__ and info.backend in ("cpu", "cuda") and info.threads >= 1
    assert info.limits["max_sessions"] == 200 and info.limits["max_particles_per_frame"] == 100_000_000
    assert client.serving() and client.address == server.address and server.address in repr(client)


def test_a_session_goes_with_its_block(client):
    with client.session(particle_radius=particle_radius, name="dam") as session:
        assert session.is_owned and str(uuid.UUID(session.id)) == session.id
        assert session.id in {info.id for info in client.sessions()}
        assert session.id in repr(session)
    assert not session.is_owned
    with refused("not_found", "NOT_FOUND"):
        client.session_info(session.id)
    with refused("not_found"):
        session.info()


def test_a_session_goes_with_its_object(client):
    session = client.session(particle_radius=particle_radius)
    name = session.id
    del session
    with refused("not_found"):
        client.session_info(name)


def test_a_session_is_described(client, positions):
    with client.session(
        particle_radius=particle_radius, name="Dam ½", up_axis="z", length_unit="m", ephemeral=False, iso=0.65
    ) as session:
        info = session.info()
        assert (info.name, info.up_axis, info.length_unit, info.ephemeral) == ("Dam ½", "z", "m", False)
        assert info.settings["iso"] == 0.65 and info.settings["particle_radius"] == particle_radius
        assert info.created_at.tzinfo == timezone.utc
        assert abs(datetime.now(timezone.utc) - info.created_at) < timedelta(minutes=5)
        assert (info.frames, info.last_frame_index, info.last_frame, info.uploading) == (0, None, None, False)
        with session.watch() as watcher, session.stream() as stream:
            stream.push(positions, index=7)
            assert stream.next(60).index == 7 and watcher.next(60).index == 7
            info = client.session_info(session.id)
            assert info.uploading and info.watchers == 1
        info = session.info()
        assert (info.frames, info.last_frame_index) == (1, 7)
        assert info.last_frame.particles == len(positions)
        assert [listed.name for listed in client.sessions() if listed.id == session.id] == [info.name]


def test_a_session_can_be_joined_and_left(client, server):
    name = str(uuid.uuid4())
    first = client.session(particle_radius=particle_radius, id=name, ephemeral=False)
    with meniscus.Client(server.address) as other:
        with other.session(particle_radius=particle_radius, id=name) as joined:
            assert joined.id == name and not joined.is_owned
        assert first.info().id == name
        with refused("already_exists", "ALREADY_EXISTS"):
            other.session(particle_radius=2 * particle_radius, id=name)
    first.leave()
    assert not first.is_owned
    del first
    assert client.session_info(name).id == name
    client.delete_session(name)
    with refused("not_found"):
        client.delete_session(name)


def test_an_ephemeral_session_that_was_left_ends_soon_after_its_stream(client, positions):
    session = client.session(particle_radius=particle_radius)
    with session.watch() as watcher:
        with session.stream() as stream:
            stream.push(positions)
        session.leave()
        assert watcher.next(60).index == 0
        # The watcher sees it end, some seconds later.
        wait_for_the_end(watcher)
    with refused("not_found"):
        client.session_info(session.id)


def test_frames_come_back_in_order(session, mesh, positions):
    with session.stream() as stream:
        for i in range(5):
            assert stream.push(positions, time=0.5 * i) == i
        assert stream.push(positions, index=9) == 9
        assert stream.push(positions) == 10
        frames = [stream.next(60) for _ in range(7)]
        assert stream.next(0) is None and not stream.ended
        stream.finish()
        assert stream.next(60) is None and stream.ended
    assert [frame.index for frame in frames] == [0, 1, 2, 3, 4, 9, 10]
    assert [frame.time for frame in frames[:5]] == [0, 0.5, 1, 1.5, 2]
    assert len({frame.run_id for frame in frames}) == 1 and frames[0].run_id != 0
    for frame in frames:
        assert frame.mesh.sha256() == mesh.sha256() and frame.mesh.statistics is None
        assert is_closed(frame.mesh.triangles) and frame.spray.shape == (0, 3)
        assert frame.dropped == () and frame.cell_size == mesh.cell_size
        assert frame.statistics.triangles == len(mesh.triangles) and frame.statistics.encoded_bytes > 0
        assert frame.statistics.volume == pytest.approx(mesh.statistics.volume)
    assert repr(frames[1]) == "<meniscus.Frame 1: time 0.5>"


def test_frames_that_were_not_taken_are_ready_after_the_block(session, positions):
    with session.stream() as stream:
        for _ in range(4):
            stream.push(positions)
    assert [frame.index for frame in stream.ready()] == [0, 1, 2, 3]
    assert stream.ended and stream.next() is None and list(stream) == []


def test_an_exception_in_the_block_cancels_the_stream(session, positions):
    with pytest.raises(ZeroDivisionError), session.stream() as stream:
        stream.push(positions)
        1 / 0
    with session.stream() as again:
        again.push(positions)
        assert again.next(60).index == 0


def test_a_frame_without_a_mesh_says_so(session, positions):
    with session.stream(meshes=False) as stream:
        stream.push(positions)
        frame = stream.next(60)
    assert frame.statistics.particles == len(positions)
    with pytest.raises(meniscus.InvalidInput, match="meshes=False"):
        frame.mesh


def test_float64_and_levels_and_empty_frames_are_pushed(session, positions):
    level = np.zeros(len(positions), int)
    level[: len(level) // 2] = 1
    here = meniscus.reconstruct(positions, particle_radius, levels=level)
    with session.stream() as stream:
        stream.push(positions.astype(float), levels=level.tolist())
        stream.push(np.asfortranarray(positions), levels=level)
        stream.push([])
        frames = [stream.next(60) for _ in range(3)]
    assert frames[0].mesh.sha256() == frames[1].mesh.sha256() == here.sha256()
    assert len(frames[2].mesh.triangles) == 0


def test_pushed_arrays_are_copied(session, positions, mesh):
    given = positions.copy()
    with session.stream() as stream:
        for _ in range(10):
            given[:] = positions
            stream.push(given)
            given[:] = 0
        assert {frame.mesh.sha256() for frame in (stream.next(60) for _ in range(10))} == {mesh.sha256()}


def test_a_newer_frame_replaces_the_one_that_waits(session):
    count, frame = 30, ball(1.0)
    with session.stream(policy="latest") as stream:
        for _ in range(count):
            stream.push(frame)
        stream.finish()
        frames = list(stream)
    dropped = [index for one in frames for index, reason in one.dropped if reason == "replaced"]
    assert sorted(dropped + [one.index for one in frames]) == list(range(count))
    assert frames[-1].index == count - 1 and stream.dropped == len(dropped) == count - len(frames)


def test_every_nth_frame(session, positions):
    with session.stream(policy="every-nth", nth=3) as stream:
        for _ in range(9):
            stream.push(positions)
        stream.finish()
        frames = list(stream)
    dropped = {index: reason for one in frames for index, reason in one.dropped}
    assert {one.index for one in frames} | set(dropped) >= set(range(7)) and set(dropped.values()) == {"not_nth"}
    assert len(frames) < 9


def test_try_push_takes_nothing_where_push_would_wait(session, positions):
    with session.stream(waiting_limit=3) as stream:
        count = 0
        while count < 3:  # it may also wait for the frame before to be sent
            count += stream.try_push(positions)
        assert not stream.try_push(positions) and not stream.try_push(positions, index=77)
        assert [stream.next(60).index for _ in range(3)] == [0, 1, 2]
        assert stream.push(positions) == 3


def test_a_second_stream_is_refused(session):
    with session.stream() as first:
        first.push([[0.0, 0.0, 0.0]])
        first.next(60)  # it is there
        with refused("failed_precondition", "FAILED_PRECONDITION"):
            second = session.stream()
            second.push([[0.0, 0.0, 0.0]])
            second.next(60)


def test_a_push_after_the_greatest_index_is_refused(session, positions):
    with session.stream() as stream:
        greatest = stream.push(positions, index=(1 << 64) - 1)
        for index in None, 0, greatest:
            with pytest.raises(meniscus.InvalidInput, match="none is greater"):
                stream.push(positions, index=index)
    assert [frame.index for frame in stream.ready()] == [greatest]


def test_a_push_after_the_end_is_refused(session, positions):
    stream = session.stream()
    stream.push(positions)
    stream.finish()
    with pytest.raises(meniscus.InvalidInput, match="finish"):
        stream.push(positions)
    assert stream.next(60).index == 0
    stream.close()
    with pytest.raises(meniscus.Error):
        stream.push(positions)
    stream.close()
    stream.cancel()


def test_a_frame_beyond_a_limit_ends_the_stream_and_not_the_session(own_server, positions):
    server = own_server("--max-particles", 100)
    with meniscus.Client(server.address) as client, client.session(particle_radius=particle_radius) as session:
        with pytest.raises(meniscus.LimitExceeded, match="100"), session.stream() as stream:
            stream.push(positions)
            stream.next(60)
        with session.stream() as stream:
            stream.push(positions[:100])
            assert stream.next(60).index == 0


def test_a_server_without_room_for_a_session_says_so(own_server):
    server = own_server("--max-sessions", 1)
    with meniscus.Client(server.address) as client, client.session(particle_radius=1.0):
        with pytest.raises(meniscus.LimitExceeded, match="1"):
            client.session(particle_radius=1.0)


def test_what_was_opened_outlives_its_client(server, positions):
    client = meniscus.Client(server.address)
    session = client.session(particle_radius=particle_radius)
    stream, watcher = session.stream(), session.watch()
    client.close()
    client.close()
    del client
    stream.push(positions)
    assert stream.next(60).index == 0 and watcher.next(60).index == 0
    session.end()
    wait_for_the_end(watcher)


def test_a_closed_client_says_so(server):
    client = meniscus.Client(server.address)
    client.close()
    for call in client.info, client.serving, client.sessions, lambda: client.session(particle_radius=1.0):
        with pytest.raises(meniscus.Error, match="clos"):
            call()


def test_a_session_that_ends_ends_its_streams_and_watchers(client, positions):
    session = client.session(particle_radius=particle_radius)
    ended = threading.Event()

    def wait():
        wait_for_the_end(watcher)
        ended.set()

    watcher = client.watch(session.id)
    waiting = threading.Thread(target=wait)
    waiting.start()
    session.end()
    session.end()
    assert ended.wait(60)
    waiting.join()
