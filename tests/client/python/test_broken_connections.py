"""A server that dies, and one that comes back."""

import gc
import sys
import threading
import weakref

import meniscus
import pytest
from support.particles import particle_radius
from test_server import refused


def test_without_reconnect_a_server_that_dies_is_an_error(own_server, positions):
    server = own_server()
    client = meniscus.Client(server.address, timeout=5)
    session = client.session(particle_radius=particle_radius)
    stream, watcher, particles = session.stream(), session.watch(), session.watch_particles()
    stream.push(positions)
    assert stream.next(60).index == watcher.next(60).index == particles.next(60).index == 0
    server.kill()
    for source in stream, watcher, particles:
        with refused("unavailable"):
            source.next(60)
    with pytest.raises(meniscus.ServerError):
        for _ in range(1000):
            stream.push(positions)
    for call in client.info, client.sessions, session.info:
        with refused("unavailable"):
            call()
    for one in stream, watcher, particles, client:
        one.close()
    del session


def test_a_block_over_a_server_that_dies_raises(own_server, positions):
    server = own_server()
    client = meniscus.Client(server.address, timeout=5)
    with refused("unavailable"):
        with client.session(particle_radius=particle_radius) as session, session.stream() as stream:
            stream.push(positions)
            assert stream.next(60).index == 0
            server.kill()
            stream.push(positions)


def test_a_client_goes_on_with_a_server_that_came_back(own_server):
    server = own_server()
    client = meniscus.Client(server.address, wait=60)
    server.kill()
    with refused("unavailable"):
        client.info()
    server.start()
    with meniscus.Client(server.address, wait=60):
        pass
    for _ in range(100):
        try:
            assert client.info().version == meniscus.__version__
            break
        except meniscus.ServerError:
            threading.Event().wait(0.1)
    else:
        pytest.fail("the client does not find the server again")


def test_with_reconnect_nothing_is_lost(own_server, positions):
    server = own_server()
    reports, broken = [], threading.Event()

    def on_reconnect(attempt, connected, reason, seconds_left):
        reports.append((attempt, connected, reason, seconds_left))
        broken.set()

    count = 30
    with meniscus.Client(server.address) as client, client.session(particle_radius=particle_radius) as session:
        with session.stream(reconnect=60, on_reconnect=on_reconnect) as stream:
            taken = []
            for i in range(count):
                stream.push(positions, time=0.1 * i)
                if i == 10:
                    taken.append(stream.next(60))
                    server.kill()
                    # A push may wait for the server, if that had not taken the frames before.
                    restart = threading.Thread(target=lambda: broken.wait(60) and server.start())
                    restart.start()
                    stream.push(positions, time=0.1 * i + 0.05)
                    restart.join()
                    assert broken.is_set()
            stream.finish()
            taken.extend(stream)
            assert [frame.index for frame in taken] == list(range(count + 1))
            assert len({frame.mesh.sha256() for frame in taken}) == 1
        assert session.info().frames > 0
    assert any(connected for _, connected, _, _ in reports)
    attempt, connected, reason, seconds_left = reports[0]
    assert attempt == 1 and connected is False and reason and 0 < seconds_left <= 60


def test_a_watcher_with_reconnect_follows(own_server, positions):
    server = own_server()
    reports = threading.Event()
    with meniscus.Client(server.address) as client, client.session(particle_radius=particle_radius) as session:
        with session.watch(reconnect=60, on_reconnect=lambda *_: reports.set()) as watcher:
            with session.watch_particles(reconnect=60) as particles, session.stream(reconnect=60) as stream:
                stream.push(positions)
                assert stream.next(60).index == watcher.next(60).index == particles.next(60).index == 0
                server.kill()
                assert reports.wait(60)
                server.start()
                stream.push(positions)
                assert stream.next(60).index == 1
                for source in watcher, particles:
                    while source.next(60).index != 1:
                        pass


def test_the_time_for_which_it_is_tried_is_kept(own_server, positions):
    server = own_server()
    reports = []
    with meniscus.Client(server.address, timeout=5) as client:
        session = client.session(particle_radius=particle_radius)
        stream = session.stream(reconnect=1, on_reconnect=lambda *one: reports.append(one))
        stream.push(positions)
        assert stream.next(60).index == 0
        server.kill()
        with refused("unavailable"):
            stream.next(60)
        assert reports and all(seconds <= 1 for _, _, _, seconds in reports)
        stream.close()


def test_an_exception_of_on_reconnect_is_reported_and_changes_nothing(own_server, positions, monkeypatch):
    reported = []
    monkeypatch.setattr(sys, "unraisablehook", lambda one: reported.append(one.exc_type))

    def on_reconnect(*_):
        raise ZeroDivisionError

    server = own_server()
    with meniscus.Client(server.address) as client, client.session(particle_radius=particle_radius) as session:
        with session.stream(reconnect=60, on_reconnect=on_reconnect) as stream:
            stream.push(positions)
            assert stream.next(60).index == 0
            server.kill()
            server.start()
            stream.push(positions)
            assert stream.next(60).index == 1
    assert reported and set(reported) == {ZeroDivisionError}


def test_a_handler_may_end_its_stream(own_server, positions):
    server = own_server()
    with meniscus.Client(server.address, timeout=5) as client:
        session = client.session(particle_radius=particle_radius)
        stream = session.stream(reconnect=60, on_reconnect=lambda *_: stream.cancel())
        stream.push(positions)
        assert stream.next(60).index == 0
        server.kill()
        try:
            assert stream.next(60) is None and stream.ended
        except meniscus.ServerError as error:
            assert error.code in ("canceled", "unavailable")
        stream.close()


@pytest.mark.parametrize("kind", ["stream", "watch", "watch_particles"])
def test_a_handler_that_refers_to_what_it_is_of_does_not_keep_it(kind, session):
    class Simulator:
        def __init__(self):
            self.source = getattr(session, kind)(reconnect=5, on_reconnect=self.report)

        def report(self, *_):
            pass

    simulator = Simulator()
    gone = [weakref.ref(simulator), weakref.ref(simulator.source)]
    simulator.source.close()
    del simulator
    gc.collect()
    assert [one() for one in gone] == [None, None]


def test_a_server_that_stops_answering_is_a_deadline(own_server):
    server = own_server()
    client = meniscus.Client(server.address, timeout=0.5)
    server.halt()
    try:
        with refused("deadline_exceeded", "DEADLINE_EXCEEDED"):
            client.info()
    finally:
        server.go_on()


def test_nobody_there_is_unavailable(socket_folder):
    with refused("unavailable") as refusal:
        meniscus.Client(f"unix:{socket_folder}/nobody")
    assert f"{socket_folder}/nobody" in str(refusal.value)


def test_a_server_that_is_still_starting_is_waited_for(own_server, socket_folder):
    connected = []
    connecting = threading.Thread(
        target=lambda: connected.append(meniscus.Client(f"unix:{socket_folder}/server", wait=60).serving())
    )
    connecting.start()
    own_server()
    connecting.join(60)
    assert connected == [True]
