"""Ctrl-C in everything that waits or computes, after which the process goes on well."""

import signal
import socket
import subprocess
import sys
import threading

import meniscus
import pytest
from support.interrupts import ctrl_c_in
from support.particles import crowd, particle_radius


@pytest.fixture(autouse=True)
def default_handler():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def mute_host():
    """Takes connections and never speaks."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        yield f"127.0.0.1:{listening.getsockname()[1]}"


def test_connecting_to_a_host_that_does_not_answer(mute_host, client):
    with pytest.raises(KeyboardInterrupt), ctrl_c_in("__init__"):
        meniscus.Client(mute_host, timeout=300)
    assert client.serving()


def test_waiting_for_a_server_that_is_not_there_yet(client, socket_folder):
    with pytest.raises(KeyboardInterrupt), ctrl_c_in("__init__"):
        meniscus.Client(f"unix:{socket_folder}/later", wait=300)
    assert client.serving()


def test_a_call_that_is_not_answered(own_server):
    server = own_server()
    client = meniscus.Client(server.address, timeout=300)
    server.halt()
    try:
        with pytest.raises(KeyboardInterrupt), ctrl_c_in("info"):
            client.info()
    finally:
        server._process.send_signal(signal.SIGCONT)
    assert client.info().version == meniscus.__version__


def test_waiting_for_a_frame_loses_none(session, positions):
    with session.stream() as stream:
        with pytest.raises(KeyboardInterrupt), ctrl_c_in("next"):
            stream.next()
        taken = []
        for _ in range(3):
            stream.push(positions)
            with pytest.raises(KeyboardInterrupt), ctrl_c_in("next"):
                while True:
                    taken.append(stream.next().index)
        stream.finish()
        assert taken + [frame.index for frame in stream] == [0, 1, 2]


def test_a_wait_with_a_limit(session):
    with session.stream() as stream, pytest.raises(KeyboardInterrupt), ctrl_c_in("next"):
        stream.next(300)


def test_a_loop_over_a_watcher(session, positions):
    taken = []
    with session.watch() as watcher, session.stream() as stream:
        stream.push(positions)
        with pytest.raises(KeyboardInterrupt), ctrl_c_in("next"):
            for frame in watcher:
                taken.append(frame.index)
        stream.push(positions)
        # The loop may begin anew. The first frame comes before Ctrl-C, or after it, or is passed over for the second.
        for frame in watcher:
            taken.append(frame.index)
            if frame.index == 1:
                break
    assert taken in ([0, 1], [1])


def test_a_push_that_waits(own_server, positions):
    server = own_server()
    frame = crowd(100000)
    with meniscus.Client(server.address) as client, client.session(particle_radius=particle_radius) as session:
        stream = session.stream(meshes=False)
        server.halt()
        try:
            with pytest.raises(KeyboardInterrupt), ctrl_c_in("push"):
                for _ in range(10000):
                    stream.push(frame)
        finally:
            server._process.send_signal(signal.SIGCONT)
        with pytest.raises(meniscus.Error, match="cancel|end"):
            stream.push(frame)
        with session.stream() as again:
            again.push(positions)
            assert again.next(60).index == 0


def test_a_reconstruction(positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius)
    frame = crowd(400000)
    with pytest.raises(KeyboardInterrupt), ctrl_c_in("_reconstruct"):
        for _ in range(100):
            reconstructor.reconstruct(frame)
    assert reconstructor.reconstruct(positions).sha256() == mesh.sha256()


def test_a_turn_that_another_thread_has(positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius, threads=1)
    frame, over = crowd(150000), threading.Event()

    def compute():
        while not over.is_set():
            reconstructor.reconstruct(frame)

    others = [threading.Thread(target=compute) for _ in range(2)]
    for other in others:
        other.start()
    try:
        with pytest.raises(KeyboardInterrupt), ctrl_c_in("_reconstruct"):
            while True:
                reconstructor.reconstruct(frame)
    finally:
        over.set()
        for other in others:
            other.join()
    assert reconstructor.reconstruct(positions).sha256() == mesh.sha256()


def test_a_handler_that_raises_something_else_ends_the_wait_with_that(session):
    class Enough(Exception):
        pass

    def handler(*_):
        raise Enough

    signal.signal(signal.SIGINT, handler)
    with session.stream() as stream:
        with pytest.raises(Enough), ctrl_c_in("next"):
            stream.next()


def test_a_handler_that_returns_ends_no_wait(session, positions):
    seen = threading.Event()
    signal.signal(signal.SIGINT, lambda *_: seen.set())
    with session.stream() as stream:
        pushing = threading.Thread(target=lambda: seen.wait(60) and stream.push(positions))
        pushing.start()
        with ctrl_c_in("next"):
            assert stream.next(60).index == 0
        pushing.join()
    assert seen.is_set()


def test_a_program_ends_by_it_as_python_programs_do(server):
    script = """
import sys, meniscus
session = meniscus.Client(sys.argv[1]).session(0.05)
stream = session.stream()
print("ready", flush=True)
stream.next()
"""
    child = subprocess.Popen(
        [sys.executable, "-B", "-c", script, server.address], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdout.readline() == "ready\n"
    child.send_signal(signal.SIGINT)
    said = child.communicate(timeout=60)[1]
    assert child.returncode == -signal.SIGINT
    assert said.rstrip().endswith("KeyboardInterrupt")
