"""Calls that wait, in a thread of their own: for asyncio."""

from __future__ import annotations

import asyncio
import queue
import threading
from concurrent.futures import Future
from typing import Any, Callable, Optional, TypeVar

T = TypeVar("T")


class Worker:
    """Makes calls one after the other. Its thread begins with the first one.

    Unlike those of an executor, the thread does not hold up the end of the program, and a call that was given is made,
    whatever becomes of the task that waits for it.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._calls: queue.SimpleQueue[Optional[Callable[[], None]]] = queue.SimpleQueue()
        self._thread: Optional[threading.Thread] = None

    def call(self, function: Callable[[], T]) -> Future[T]:
        """The future cannot be cancelled."""
        future: Future[T] = Future()
        future.set_running_or_notify_cancel()
        self._calls.put(lambda: _run(function, future))
        if self._thread is None:
            self._thread = threading.Thread(target=_work, args=(self._calls,), name=self._name, daemon=True)
            self._thread.start()
        return future

    def stop(self) -> None:
        """Waits for the end of the calls that were given, unless one of them is this."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._calls.put(None)
            if thread is not threading.current_thread():
                thread.join()

    def __del__(self) -> None:
        self._calls.put(None)


async def in_background(function: Callable[[], T]) -> T:
    """The result of a call that waits. It is made to its end, also where the task that waits for it is cancelled."""
    return await asyncio.wrap_future(Worker("meniscus").call(function))


def _run(function: Callable[[], Any], future: Future[Any]) -> None:
    try:
        result = function()
    except BaseException as error:
        future.set_exception(error)
    else:
        future.set_result(result)


def _work(calls: queue.SimpleQueue[Optional[Callable[[], None]]]) -> None:
    while (call := calls.get()) is not None:
        call()
        del call  # with what it refers to
