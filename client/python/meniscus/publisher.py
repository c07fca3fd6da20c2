"""Surfaces that were made in this process, for the watchers of a session."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Optional, Union

from . import _meniscus
from .errors import InvalidInput
from .frame import Frame
from .mesh import Mesh
from .types import BrickBox, Real, Whole
from .uploading import Uploads


class Publisher(Uploads):
    """Publishes surfaces, in order, to a session that no particles come to; from Session.publish() or
    Client.publish().

    The session's settings are those that the surfaces were made with. That they are closed is the publisher's promise.
    At the end of a ``with`` block the publisher is finished and waits until the server has answered all frames: the
    answers, frames with their figures and without their meshes, are still given by ready(). After an exception it is
    cancelled.
    """

    def __init__(self, raw: _meniscus.Publisher) -> None:
        super().__init__(raw, lambda frame: Frame(frame, has_mesh=False))
        self._raw = raw

    def push(
        self,
        surface: Union[Mesh, Frame],
        *,
        time: Optional[Real] = None,
        index: Optional[Whole] = None,
        bricks: Optional[BrickBox] = None,
    ) -> int:
        """Publishes one surface; waits while the server does not take more. Returns the frame's index.

        surface: a Mesh of a Reconstructor with ``keep_lattice=True``, encoded here, with its spray and all of its
        attributes; or a Frame, such as one of a recording or of a watcher, whose bricks pass as they came: it has to be
        whole, with all attributes, and of the codec "packed" or "entropy". ``time`` is the simulation's; None: a
        frame's own, 0 for a mesh. ``index`` is greater than the one before; None: by one, from 0.

        bricks: with ``parts``, those that this one publishes of a Mesh that reaches farther, such as that of a rank
        with particles of its neighbors: (lowest, highest), both among them, each x y z, with None for no end. The boxes
        of all publishers cover the surface, and no brick is in two of them. The brick (x, y, z) covers the world from
        (x, y, z) to (x + 1, y + 1, z + 1) times its edge, which is 64 * cell_size * particle_radius. With the default
        settings the bricks of a box are those of the whole frame where the mesh was made of all particles within 27
        radii of it. Counts of the mesh and the volume are those of the box, figures of the particles and of the work
        stay the mesh's; attributes of float32 want ``attribute_bits=0``, since all parts round over one range. None:
        all bricks.

        Raises InvalidInput for a mesh without its lattice and for a box that is none, which is then not pushed;
        InvalidInput, LimitExceeded or ServerError for what the server has refused. Ctrl-C in a wait cancels the
        publisher.
        """
        if isinstance(surface, Mesh):
            return self._raw.push_mesh(surface._raw, index, 0.0 if time is None else time, bricks)
        if isinstance(surface, Frame):
            if bricks is not None:
                raise InvalidInput("bricks are chosen of a Mesh; those of a Frame are all published")
            surface.require_mesh()
            return self._raw.push_frame(surface._raw, index, surface.time if time is None else time)
        raise InvalidInput(f"surface is of the type {type(surface).__name__}, must be a Mesh or a Frame")

    async def apush(
        self,
        surface: Union[Mesh, Frame],
        *,
        time: Optional[Real] = None,
        index: Optional[Whole] = None,
        bricks: Optional[BrickBox] = None,
    ) -> int:
        """push() for asyncio, one after the other. A task that is cancelled while it waits has pushed the surface all
        the same."""
        return await asyncio.wrap_future(
            self._pushes.call(partial(self.push, surface, time=time, index=index, bricks=bricks))
        )
