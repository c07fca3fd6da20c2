"""The thread that makes surfaces while Blender goes on: first what is to be shown, then what fills a cache."""

import threading
from collections import OrderedDict, deque
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Result:
    """The surface that was made for a request, or the error."""

    name: str  #: of the object that has asked
    request: Any
    made: Any  #: None: see the error
    error: str


@dataclass
class Filling:
    """How far the cache of an object's sequence is filled."""

    waiting: deque
    total: int
    failed: int = 0
    error: str = ""  #: the first one
    busy: bool = False

    @property
    def done(self):
        return self.total - len(self.waiting) - self.busy


class Worker:
    """make and prepare: functions of a request, called in the worker's thread, one at a time. What they raise becomes
    the error of the result."""

    def __init__(self, make, prepare):
        self._make = make
        self._prepare = prepare
        self._asked = OrderedDict()
        self._making = None  # name and request of what is being made
        self._results = OrderedDict()
        self._fillings = {}
        self._ends = False
        self._changed = threading.Condition()
        self._thread = None

    def ask(self, name, request):
        """For an object's surface. A request of the object's that still waits is forgotten."""
        with self._changed:
            if self._making == (name, request):
                self._asked.pop(name, None)
                return
            self._asked[name] = request
            self._start()

    def take(self):
        """Results that have come since, one an object: the newest."""
        with self._changed:
            results = list(self._results.values())
            self._results.clear()
        return results

    def fill(self, name, requests):
        """Prepares all of them, in place of what was being prepared for the object."""
        with self._changed:
            waiting = deque(requests)
            self._fillings[name] = Filling(waiting, len(waiting))
            self._start()

    def stop_filling(self, name):
        with self._changed:
            self._fillings.pop(name, None)

    def filling(self, name):
        """The object's Filling, or None. One that is done stays until the next."""
        with self._changed:
            return self._fillings.get(name)

    @property
    def is_busy(self):
        """Whether anything waits, is being made, or was not taken."""
        with self._changed:
            return bool(self._results) or self._has_work()

    def wait(self, seconds=None):
        """Until nothing is left to be made. Gives whether that is so; without a limit, it always is."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._has_work(), seconds)

    def is_making(self, name):
        """Whether the object waits for a surface."""
        with self._changed:
            return name in self._asked or (self._making is not None and self._making[0] == name)

    def close(self, seconds=10.0):
        """Forgets what waits, and waits until what is being made is there."""
        with self._changed:
            self._ends = True
            self._asked.clear()
            self._fillings.clear()
            self._changed.notify_all()
            thread = self._thread
        if thread is not None:
            thread.join(seconds)

    def _start(self):
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="meniscus", daemon=True)
            self._thread.start()
        self._changed.notify_all()

    def _run(self):
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ends or self._asked or self._next_filling())
                if self._ends:
                    return
                if self._asked:
                    self._making = self._asked.popitem(last=False)
                    filling = None
                else:
                    filling = self._next_filling()
                    request, filling.busy = filling.waiting.popleft(), True
            if filling is None:
                self._make_asked(*self._making)
            else:
                self._fill(filling, request)

    def _has_work(self):
        return bool(self._asked or self._making or any(f.waiting or f.busy for f in self._fillings.values()))

    def _next_filling(self):
        return next((filling for filling in self._fillings.values() if filling.waiting), None)

    def _make_asked(self, name, request):
        made, error = None, ""
        try:
            made = self._make(request)
        except Exception as raised:
            error = error_text(raised)
        with self._changed:
            self._results[name] = Result(name, request, made, error)
            self._making = None
            self._changed.notify_all()

    def _fill(self, filling, request):
        error = ""
        try:
            self._prepare(request)
        except Exception as raised:
            error = error_text(raised)
        with self._changed:
            filling.busy = False
            if error:
                filling.failed += 1
                filling.error = filling.error or error
            self._changed.notify_all()


def error_text(error):
    """The error in one line. One without a text, such as MemoryError, is named."""
    return " ".join(str(error).split()) or type(error).__name__
