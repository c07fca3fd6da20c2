"""A simulator's stream: particle frames out, meshes in."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Mapping, Optional

from . import _meniscus, arrays
from .frame import Frame
from .types import ArrayLike, Real, Whole
from .uploading import Uploads


class Stream(Uploads):
    """Uploads frames and receives their meshes, in order; from Session.stream() or Client.stream().

    At the end of a ``with`` block the stream is finished and waits until the server has answered all frames; those
    that were not taken yet are still given by ready(). After an exception it is cancelled.

    Received frames wait, encoded, until they are taken: take them, or open the stream with ``meshes=False``.
    """

    def __init__(self, raw: _meniscus.Stream, meshes: bool) -> None:
        super().__init__(raw, lambda frame: Frame(frame, meshes))
        self._raw = raw

    def push(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
        time: Real = 0.0,
        index: Optional[Whole] = None,
    ) -> int:
        """Sends one frame, copied; waits while the server does not take more. Returns the frame's index.

        The arrays are those of Reconstructor.reconstruct(); those on a GPU are copied down by their library. ``time``
        is the simulation's. ``index`` is greater than the one before; None: by one, from 0. Raises InvalidInput for
        arrays that are wrong, and the frame is then not pushed; InvalidInput, LimitExceeded or ServerError for what
        the server has refused. Ctrl-C in a wait cancels the stream.
        """
        return self._raw.push(*arrays.frame_on_host(positions, levels, attributes), index, time)

    def try_push(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
        time: Real = 0.0,
        index: Optional[Whole] = None,
    ) -> bool:
        """Pushes where push() would not wait; otherwise False, and nothing was taken, neither the frame nor its
        index."""
        return self._raw.try_push(*arrays.frame_on_host(positions, levels, attributes), index, time)

    async def apush(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
        time: Real = 0.0,
        index: Optional[Whole] = None,
    ) -> int:
        """push() for asyncio, one after the other. A task that is cancelled while it waits has pushed the frame all
        the same; until then the arrays must stay as they are."""
        push = partial(self.push, positions, levels=levels, attributes=attributes, time=time, index=index)
        return await asyncio.wrap_future(self._pushes.call(push))
