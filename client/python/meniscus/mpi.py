"""Surfaces of the particles of an MPI job, made by its ranks beside the simulation: needs mpi4py.

Each rank pushes the particles that it owns; they are gathered nowhere. Some ranks reconstruct a part of each frame, and
publish it to a session of a server, where watchers get one surface: to the bit that of the whole frame. Or they write
files, in place of the server: ``output="surfaces"``.

    >>> from mpi4py import MPI
    >>> import meniscus.mpi
    >>> with meniscus.mpi.Parts(MPI.COMM_WORLD, 0.02, server="water:50051", name="dam") as parts:
    ...     for step in range(100):
    ...         parts.push(positions, attributes={"velocity": velocity}, time=0.01 * step)
"""

from __future__ import annotations

import itertools
import os
from types import TracebackType
from typing import Any, Mapping, Optional, Sequence, Type, Union

from mpi4py import MPI

from . import _meniscus, arrays
from .errors import InvalidInput, LimitExceeded
from .options import names_text, option_texts
from .types import ArrayLike, Real, Whole

#: Most bytes of one message: MPI counts in int.
_MOST = 1 << 30

_Bytes = Union[bytes, bytearray, memoryview]


class Parts:
    """The frames of a job's ranks. All calls are made by all ranks together, in the same order; MPI is called in them
    alone, on the thread that calls, on a duplicate of ``comm`` (MPI_THREAD_FUNNELED suffices).

    The keywords are the settings, as Reconstructor has them; ``server`` ("HOST:PORT") and the other keywords of Client,
    for a connection; ``name``, ``id`` and the others of Client.session(), for the session, which the first rank that
    reconstructs opens; those of Client.publish() but ``parts``, ``part`` and ``run``; and

    output              in place of ``server`` and its keywords: a folder that the ranks that reconstruct share. It gets
                        surface-FRAME-part-PART.vtp of each of them, and surface.pvd, which lists the frames that are
                        there whole, for ParaView: by their times where these increase, else by their numbers. A folder
                        that has a list is refused.

    policy              "latest": a frame that comes while one is made is left out, on all ranks: push() waits for no
                        reconstruction; "every-frame": none is, and push() waits for the frame before
    reconstruct_ranks   "node": one rank of each machine reconstructs; "all"; or their number
    overlap             4: base cells around a part that settle with it the first time

    At the end of a ``with`` block the last frame is published. After an exception it is not, and other ranks wait: let
    the job end as MPI jobs do, by ``MPI.COMM_WORLD.Abort()`` or by ``python3 -m mpi4py``.

    Raises InvalidInput for a wrong argument, ServerError for a server that is not there; an error of one rank is raised
    on all, with its number.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        particle_radius: Real,
        *,
        server: Optional[str] = None,
        output: Optional[Union[str, os.PathLike[str]]] = None,
        attributes: Union[str, Sequence[str]] = "all",
        **options: Any,
    ) -> None:
        texts: dict[str, str] = {}
        wrong: Optional[str] = None
        try:
            if not (output is None or isinstance(output, (str, os.PathLike))):
                raise InvalidInput(f"output is {output!r}, must be a path")
            texts = option_texts({"particle_radius": particle_radius, "server": server, "output": output, **options})
            if "id" in texts:
                texts["session"] = texts.pop("id")
            texts["attribute"] = names_text(attributes)
        except InvalidInput as error:
            wrong = str(error)
        self._exchange: Optional[_Exchange] = _Exchange(comm)
        try:
            self._exchange.refuse(wrong)
            self._raw: Optional[_meniscus.Parts] = _meniscus.make_parts(self._exchange, texts)
        except BaseException:
            self._exchange.free()
            raise

    @property
    def session_id(self) -> str:
        """For watchers; empty where files are written."""
        return self._opened().session_id()

    @property
    def dropped(self) -> int:
        """Frames left out so far."""
        return self._opened().dropped()

    def push(
        self,
        positions: ArrayLike,
        *,
        time: Real = 0.0,
        index: Optional[Whole] = None,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
    ) -> bool:
        """Takes the particles that this rank owns, none or many, each on one rank; returns when they are copied. The
        next call but one publishes the frame, with the policy "every-frame" the next one, or finish(). False: the frame
        is left out, on all ranks.

        The arrays are those of Reconstructor.reconstruct(). ``time`` and ``index`` are the same on all ranks; index is
        greater than the one before, and None is the one after it, from 0.

        Raises InvalidInput, LimitExceeded, ServerError or Error, on all ranks alike, also for the frames before; the
        next frame may come. A server that is away raises ServerError (unavailable) once for each attempt to reach it
        again, and files that cannot be written Error; frames are left out meanwhile.
        """

        def frame() -> arrays.Frame:
            return arrays.frame(positions, levels, attributes)

        return self._opened().push(frame, index, time)

    def finish(self) -> None:
        """Publishes what was pushed, and waits until the server has answered or the files are listed; no frame may
        follow. Raises as push()."""
        self._opened().finish()

    def close(self) -> None:
        """Ends the session if these parts have opened it. What is not finished is lost."""
        self._raw = None
        if self._exchange is not None:
            self._exchange.free()
            self._exchange = None

    def __enter__(self) -> Parts:
        return self

    def __exit__(
        self,
        kind: Optional[Type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        if kind is not None:
            return  # the other ranks do not know of it
        try:
            self.finish()
        finally:
            self.close()

    def _opened(self) -> _meniscus.Parts:
        if self._raw is None:
            raise InvalidInput("the parts are closed: make others with meniscus.mpi.Parts")
        return self._raw


class _Exchange:
    """What the library asks of MPI, on a communicator of its own."""

    def __init__(self, comm: MPI.Intracomm) -> None:
        self._comm = comm.Dup()
        self.rank = self._comm.rank
        self.ranks = self._comm.size
        node = self._comm.Split_type(MPI.COMM_TYPE_SHARED)
        self.leads_node = node.rank == 0
        node.Free()

    def refuse(self, wrong: Optional[str]) -> None:
        """Raises InvalidInput on all ranks for what is wrong on one; None: nothing is."""
        for rank, its in enumerate(self._comm.allgather(wrong)):
            if its is not None:
                raise InvalidInput(f"rank {rank}: {its}")

    def gather(self, mine: bytes) -> list[_Bytes]:
        """The bytes of all, by rank."""
        sizes = self._comm.allgather(len(mine))
        if sum(sizes) > _MOST:
            raise LimitExceeded(
                f"the ranks have {sum(sizes)} bytes to tell all others, at most {_MOST} are possible: let fewer ranks "
                "reconstruct (reconstruct_ranks)"
            )
        together = bytearray(sum(sizes))
        self._comm.Allgatherv(mine, [together, sizes, MPI.BYTE])
        ends = list(itertools.accumulate(sizes))
        return [memoryview(together)[end - size : end] for size, end in zip(sizes, ends)]

    def trade(self, to: list[bytes]) -> list[_Bytes]:
        """to: for each rank. Returns the bytes that each has sent to this one. In turns: to each rank, from the one
        that is as far on the other side."""
        sizes = self._comm.alltoall([len(each) for each in to])
        received: list[_Bytes] = [b""] * self.ranks
        received[self.rank] = to[self.rank]
        for turn in range(1, self.ranks):
            after, before = (self.rank + turn) % self.ranks, (self.rank - turn) % self.ranks
            piece = bytearray(sizes[before])
            for at in range(0, max(len(to[after]), sizes[before]), _MOST):
                # Ranks come to different numbers of pieces: no empty one is sent.
                self._comm.Sendrecv(
                    memoryview(to[after])[at : at + _MOST],
                    after if at < len(to[after]) else MPI.PROC_NULL,
                    recvbuf=memoryview(piece)[at : at + _MOST],
                    source=before if at < sizes[before] else MPI.PROC_NULL,
                )
            received[before] = piece
        return received

    def free(self) -> None:
        """Called by all ranks."""
        self._comm.Free()
