"""Several threads on one object, and on the arrays that are being read."""

import threading
import warnings
from concurrent.futures import ThreadPoolExecutor

import meniscus
import numpy as np
import pytest
from support.interrupts import MainThread
from support.particles import ball, crowd, particle_radius


def test_threads_on_one_reconstructor_take_turns():
    frames = [ball(0.25 + 0.05 * i) for i in range(6)]
    expected = [meniscus.reconstruct(frame, particle_radius).sha256() for frame in frames]
    reconstructor = meniscus.Reconstructor(particle_radius)

    def one(i):
        mesh = reconstructor.reconstruct(frames[i % len(frames)], attributes={"place": frames[i % len(frames)]})
        found = mesh.sha256(), np.isfinite(mesh.attributes["place"]).all()
        return i % len(frames), *found

    with ThreadPoolExecutor(4) as threads:
        for i, sha256, finite in threads.map(one, range(40)):
            assert sha256 == expected[i] and finite


def test_threads_that_do_different_things_with_one_reconstructor_never_crash(positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius)
    reconstructor.reconstruct(positions)

    def one(i):
        if i % 4 == 0:
            return reconstructor.release_memory()
        if i % 4 == 1:
            try:
                return reconstructor.coarser(1 + i % 3)
            except meniscus.InvalidInput:
                return None  # the memory was released just now
        if i % 4 == 2:
            return reconstructor.settings["iso"]
        return reconstructor.reconstruct(positions)

    with ThreadPoolExecutor(4) as threads:
        list(threads.map(one, range(60)))
    assert reconstructor.reconstruct(positions).sha256() == mesh.sha256()


def test_filters_of_warnings_are_left_to_the_process():
    found = []

    class Particles:
        def __array__(self, dtype=None, copy=None):
            found.append(list(warnings.filters))  # as another thread sees them meanwhile
            return ball()

    before = list(warnings.filters)
    meniscus.reconstruct(Particles(), particle_radius)
    assert found and all(filters == before for filters in found)


def test_a_mesh_is_looked_at_by_several_threads(positions, mesh):
    def one(i):
        fresh = meshes[i % len(meshes)]
        return fresh.vertices.sum(), fresh.levels.sum(), fresh.sha256(), len(fresh.attributes)

    meshes = [meniscus.reconstruct(positions, particle_radius, attributes={"place": positions}) for _ in range(2)]
    with ThreadPoolExecutor(4) as threads:
        assert len(set(threads.map(one, range(40)))) == 1


def test_arrays_that_change_meanwhile_give_some_mesh_and_never_a_crash(positions):
    given, level, ids = positions.copy(), np.zeros(len(positions), np.uint8), np.arange(len(positions))
    over = threading.Event()

    def change():
        i = 0
        while not over.is_set():
            given[:] = positions * (1.0 + 0.1 * (i % 7))
            given[i % len(given)] = np.nan if i % 3 == 0 else 1e30
            level[:] = i % 6
            ids[:] = i
            i += 1

    thread = threading.Thread(target=change)
    thread.start()
    reconstructor = meniscus.Reconstructor(particle_radius, domain=((-1, -1, -1), (1, 1, 1)))
    try:
        for _ in range(40):
            try:
                reconstructor.reconstruct(given, levels=level, attributes={"id": ids, "place": given})
            except meniscus.InvalidInput:
                pass
    finally:
        over.set()
        thread.join()
    place = {"id": ids * 0, "place": positions}
    assert len(reconstructor.reconstruct(positions, attributes=place).triangles) > 0


def test_other_threads_run_while_a_surface_is_computed():
    seen = []
    over = threading.Event()
    watching = threading.Thread(target=lambda: seen.append(MainThread("_reconstruct").is_waiting(over)))
    reconstructor = meniscus.Reconstructor(particle_radius)
    frame = crowd(60000)
    watching.start()
    # With the lock held, the main thread could not be seen at the same place twice.
    for _ in range(20):
        reconstructor.reconstruct(frame)
        if not watching.is_alive():
            break
    over.set()
    watching.join()
    assert seen == [True]


def test_one_thread_pushes_and_another_takes(session, positions):
    with session.stream() as stream:
        taken = []
        taking = threading.Thread(target=lambda: taken.extend(frame.index for frame in stream))
        taking.start()
        for i in range(20):
            assert stream.push(positions * (1 + 0.01 * i), time=0.1 * i) == i
        stream.finish()
        taking.join(60)
        assert taken == list(range(20)) and stream.ended


def test_several_threads_push_and_take_without_a_loss(session, positions):
    count = 40
    lock, taken = threading.Lock(), []
    with session.stream() as stream:

        def push(_):
            # Indices grow; which of the threads sends next is open.
            stream.push(positions)

        def take(_):
            while (frame := stream.next(60)) is not None:
                with lock:
                    taken.append(frame.index)

        with ThreadPoolExecutor(6) as threads:
            takers = [threads.submit(take, i) for i in range(3)]
            for pushed in [threads.submit(push, i) for i in range(count)]:
                pushed.result(60)
            stream.finish()
            for taker in takers:
                taker.result(60)
    assert sorted(taken) == list(range(count))


@pytest.mark.parametrize("end", ["cancel", "close"])
def test_the_end_of_a_stream_wakes_those_that_wait(end, session, positions):
    stream = session.stream()
    with ThreadPoolExecutor(4) as threads:
        waiting = [threads.submit(stream.next) for _ in range(3)]
        stream.push(positions)
        getattr(stream, end)()
        found = [one.result(60) for one in waiting]
    assert len([frame for frame in found if frame is not None]) <= 1
    with session.stream() as again:
        again.push(positions)
        assert again.next(60).index == 0


def test_close_and_cancel_at_the_same_time_never_crash(session, positions):
    for _ in range(5):
        stream, watcher = session.stream(), session.watch()
        stream.push(positions)
        with ThreadPoolExecutor(6) as threads:
            calls = [stream.cancel, stream.close, watcher.cancel, watcher.close, stream.next, watcher.next]
            done = [threads.submit(call) for call in calls]
            for one in done:
                try:
                    one.result(60)
                except meniscus.Error:
                    pass
    assert session.info().id == session.id


def test_a_client_serves_several_threads(server, positions):
    with meniscus.Client(server.address) as client:

        def one(i):
            with client.session(particle_radius=particle_radius) as session, session.stream() as stream:
                stream.push(positions)
                return stream.next(60).mesh.sha256(), client.session_info(session.id).id == session.id

        with ThreadPoolExecutor(4) as threads:
            assert len(set(threads.map(one, range(8)))) == 1


def test_a_client_that_is_closed_by_another_thread_never_crashes(server):
    for _ in range(5):
        client = meniscus.Client(server.address)

        def ask(_, client=client):
            try:
                return client.info().version
            except meniscus.Error as error:
                return str(error)

        with ThreadPoolExecutor(4) as threads:
            asked = [threads.submit(ask, i) for i in range(8)]
            client.close()
            assert all(one.result(60) for one in asked)
