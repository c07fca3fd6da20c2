"""The thread that makes surfaces."""

import threading

import pytest

from meniscus_blender.worker import Worker

PATIENCE = 20.0


class Kitchen:
    """Makes a request when it is let, and shows that it has begun."""

    def __init__(self):
        self.begun = threading.Semaphore(0)
        self.let = threading.Semaphore(0)
        self.made = []

    def make(self, request):
        self.begun.release()
        assert self.let.acquire(timeout=PATIENCE)
        self.made.append(request)
        if request == "bad":
            raise ValueError("no such\nfile")
        if request == "silent":
            raise MemoryError
        return request.upper()


@pytest.fixture
def kitchen():
    return Kitchen()


@pytest.fixture
def worker(kitchen):
    worker = Worker(kitchen.make, kitchen.make)
    yield worker
    for _ in range(100):
        kitchen.let.release()
    worker.close()


def test_a_surface_comes_by_the_name_of_its_object(kitchen, worker):
    kitchen.let.release()
    worker.ask("water", "frame 1")
    assert worker.wait(PATIENCE)
    (result,) = worker.take()
    assert (result.name, result.request, result.made, result.error) == ("water", "frame 1", "FRAME 1", "")
    assert worker.take() == [] and not worker.is_busy


def test_only_the_newest_request_of_an_object_is_made(kitchen, worker):
    worker.ask("water", "frame 1")
    assert kitchen.begun.acquire(timeout=PATIENCE)
    for number in range(2, 50):
        worker.ask("water", f"frame {number}")
        worker.ask("oil", "frame 0")
    assert worker.is_making("water") and worker.is_making("oil")
    for _ in range(3):
        kitchen.let.release()
    assert worker.wait(PATIENCE)
    assert sorted(kitchen.made) == ["frame 0", "frame 1", "frame 49"]
    assert sorted(result.made for result in worker.take()) == ["FRAME 0", "FRAME 49"]


def test_what_is_being_made_is_not_made_twice(kitchen, worker):
    worker.ask("water", "frame 1")
    assert kitchen.begun.acquire(timeout=PATIENCE)
    worker.ask("water", "frame 1")
    kitchen.let.release()
    assert worker.wait(PATIENCE)
    assert kitchen.made == ["frame 1"]


def test_an_error_is_one_line_and_the_next_surface_comes(kitchen, worker):
    for request, text in (("bad", "no such file"), ("silent", "MemoryError")):
        kitchen.let.release()
        worker.ask("water", request)
        assert worker.wait(PATIENCE)
        (result,) = worker.take()
        assert (result.made, result.error) == (None, text)
    kitchen.let.release()
    worker.ask("water", "good")
    assert worker.wait(PATIENCE)
    assert worker.take()[0].made == "GOOD"


def test_who_waits_comes_before_who_fills_a_cache(kitchen, worker):
    worker.fill("water", ["a", "b", "bad"])
    assert kitchen.begun.acquire(timeout=PATIENCE)
    worker.ask("water", "now")
    for _ in range(4):
        kitchen.let.release()
    assert worker.wait(PATIENCE)
    assert kitchen.made == ["a", "now", "b", "bad"]
    filling = worker.filling("water")
    assert (filling.done, filling.total, filling.failed, filling.error) == (3, 3, 1, "no such file")
    assert [result.made for result in worker.take()] == ["NOW"]  # what fills a cache is shown to nobody


def test_filling_stops_after_the_frame_that_is_made(kitchen, worker):
    worker.fill("water", ["a", "b", "c"])
    assert kitchen.begun.acquire(timeout=PATIENCE)
    assert worker.filling("water").done == 0
    worker.stop_filling("water")
    kitchen.let.release()
    worker.ask("water", "end")
    kitchen.let.release()
    assert worker.wait(PATIENCE)
    assert kitchen.made == ["a", "end"] and worker.filling("water") is None


def test_closing_waits_for_what_is_made_and_forgets_the_rest(kitchen):
    worker = Worker(kitchen.make, kitchen.make)
    worker.ask("water", "frame 1")
    assert kitchen.begun.acquire(timeout=PATIENCE)
    worker.ask("oil", "frame 2")
    worker.fill("water", ["a"])
    kitchen.let.release()
    worker.close(PATIENCE)
    assert kitchen.made == ["frame 1"] and not worker._thread.is_alive()


def test_a_worker_that_was_never_asked_closes(kitchen):
    Worker(kitchen.make, kitchen.make).close()
