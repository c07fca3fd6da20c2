"""The common part of streams and publishers: frames that go up one after the other, and their answers."""

from __future__ import annotations

from collections import deque
from concurrent.futures import wait
from typing import Callable, Protocol

from . import _meniscus
from .background import Worker
from .frame import Frame
from .receiving import Frames, RawSource


class RawUpload(RawSource, Protocol):
    """The C++ side of it."""

    def finish(self) -> None:
        ...

    def dropped(self) -> int:
        ...


class Uploads(Frames[Frame]):
    """Frames that are sent, in order, and their answers."""

    def __init__(self, raw: RawUpload, make: Callable[[_meniscus.Frame], Frame]) -> None:
        super().__init__(raw, make)
        self._upload = raw
        self._pushes = Worker("meniscus-push")

    def finish(self) -> None:
        """No more frames will be pushed: ``for frame in`` this ends after the last one."""
        self._upload.finish()

    @property
    def dropped(self) -> int:
        """Frames that the policy has left out so far."""
        return self._upload.dropped()

    def close(self) -> None:
        """Cancels what is in flight."""
        super().close()
        self._pushes.stop()

    def __exit__(self, *raised: object) -> None:
        try:
            if raised[0] is None:
                self.finish()
                self._wait_for_answers()
        finally:
            self.close()

    def _wait_for_answers(self) -> None:
        """They can be taken later."""
        answers: deque[Frame] = deque()
        try:
            if self._receiving is not None:
                wait([self._receiving])  # a task that was cancelled has left it; its frame comes before the others
            answers.extend(self)
        finally:
            answers.extend(self._received)
            self._received = answers
