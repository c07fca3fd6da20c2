"""The common part of streams, watchers and readers of recordings: frames that come one after the other."""

from __future__ import annotations

import asyncio
import atexit
import weakref
from collections import deque
from concurrent.futures import Future
from typing import Any, AsyncIterator, Callable, Generic, Iterator, Optional, Protocol, TypeVar

from .background import Worker, in_background

F = TypeVar("F")


class RawSource(Protocol):
    """The C++ side of it."""

    def next(self, seconds: Optional[float]) -> tuple[Any, bool]:
        ...

    def cancel(self) -> None:
        ...


class Handler:
    """The object that C++ has in place of a function that gets reports. The function often refers to the frames that
    refer to it, a circle that Python's garbage collector cannot see through C++: cancel() cuts it here."""

    def __init__(self, function: Callable[..., None]) -> None:
        self.function: Optional[Callable[..., None]] = function

    def __call__(self, *report: Any) -> None:
        if (function := self.function) is not None:
            function(*report)

    def __repr__(self) -> str:
        return repr(self.function)


class Frames(Generic[F]):
    """Frames that are received. ``for frame in frames`` waits for each until there are no more; so does ``async for``.

    Several threads may use one; those that wait for frames take turns. Ctrl-C ends a wait and nothing else.
    """

    #: An asynchronous wait is cut into pieces of this many seconds: one that nobody waits for any more ends soon.
    _piece = 0.25

    def __init__(self, raw: RawSource, make: Callable[[Any], F]) -> None:
        self._source = raw
        self._handler: Optional[Handler] = None
        self._make = make
        self._received: deque[F] = deque()  # and not taken yet
        self._ended = False
        self._worker = Worker("meniscus-next")
        self._receiving: Optional[Future[None]] = None
        self._failure: Optional[BaseException] = None  # of what was received for nobody
        _open.add(self)

    @property
    def ended(self) -> bool:
        """Whether there are no more frames."""
        return self._ended and not self._received

    def next(self, timeout: Optional[float] = None) -> Optional[F]:
        """The next frame. None: there are no more (``ended``), or none has come in ``timeout`` seconds.

        0 does not wait, None waits for as long as it takes. Raises InvalidInput, LimitExceeded or ServerError.
        """
        if (frame := self._first()) is not None:
            return frame
        raw, ended = self._source.next(timeout)
        self._ended = self._ended or ended
        return None if raw is None else self._make(raw)

    def ready(self) -> Iterator[F]:
        """The frames that have come by now; waits for none."""
        while (frame := self.next(0)) is not None:
            yield frame

    def __iter__(self) -> Iterator[F]:
        while (frame := self.next()) is not None:
            yield frame

    async def anext(self) -> Optional[F]:
        """The next frame, or None if there are no more. A task that is cancelled while it waits loses no frame."""
        while True:
            if (frame := self._first()) is not None:
                return frame
            if self._ended:
                return None
            if self._receiving is None or self._receiving.done():
                self._receiving = self._worker.call(self._receive_ahead)
            await asyncio.wrap_future(self._receiving)

    async def __aiter__(self) -> AsyncIterator[F]:
        while (frame := await self.anext()) is not None:
            yield frame

    def cancel(self) -> None:
        """Ends it at once, from any thread, and a wait in another one, which then has no more frames."""
        self._source.cancel()
        if self._handler is not None:
            self._handler.function = None

    def close(self) -> None:
        """Ends it as cancel() does; the end of a ``with`` block calls it."""
        self.cancel()
        self._worker.stop()

    def __enter__(self: S) -> S:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    async def __aenter__(self: S) -> S:
        return self

    async def __aexit__(self, *raised: object) -> None:
        try:
            await in_background(lambda: self.__exit__(*raised))
        except asyncio.CancelledError:
            self.cancel()
            raise

    def _first(self) -> Optional[F]:
        """The first frame that was received and not taken; None without one. Raises the error that came instead."""
        try:
            return self._received.popleft()
        except IndexError:
            failure, self._failure = self._failure, None
            if failure is not None:
                raise failure from None
            return None

    def _receive_ahead(self) -> None:
        """Keeps the next frame or error for the next caller: the task that waits may be cancelled meanwhile."""
        try:
            frame = self.next(self._piece)
        except Exception as error:
            self._failure = error
        else:
            if frame is not None:
                self._received.append(frame)


S = TypeVar("S", bound=Frames[Any])

#: Those that are there. At the end of the program their threads must not wait any more.
_open: weakref.WeakSet[Frames[Any]] = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    for frames in list(_open):
        frames.close()
