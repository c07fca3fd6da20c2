"""The frames that come from a server: of meshes, and of particles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Mapping, Optional

import numpy as np

from . import _meniscus
from .errors import InvalidInput
from .mesh import Mesh
from .statistics import Statistics

if TYPE_CHECKING:  # from numpy 1.20 on
    from numpy.typing import NDArray


@dataclass(frozen=True)
class AttributeForm:
    """An attribute of the vertices of a frame's surface, whether it was asked for or not."""

    type: str  #: "float32", "uint8", "int32" or "uint32"
    components: int
    minimum: Optional[tuple[float, ...]]  #: of each component over the whole surface; None where it has no vertices
    maximum: Optional[tuple[float, ...]]


class Frame:
    """One received frame. The mesh stays encoded until it is asked for."""

    def __init__(self, raw: _meniscus.Frame, has_mesh: bool = True) -> None:
        self._raw = raw
        self._has_mesh = has_mesh
        self.index: int = raw.index  #: as it was pushed
        self.run_id: int = raw.run_id  #: of the run of frames that the simulator sends; 0: of no run
        self.time: float = raw.time  #: of the simulation, as it was pushed
        self.cell_size: float = raw.cell_size  #: edge of a finest cell, world units
        #: To a watcher: bricks (x, y, z) that are new or differ from the frame before, and those that are gone.
        self.changed: tuple[tuple[int, int, int], ...] = raw.changed
        self.vanished: tuple[tuple[int, int, int], ...] = raw.vanished
        #: From a stream: frames that the server left out since the frame before: (index, "replaced", "not_nth", or
        #: "incomplete" where another part of it is missing).
        self.dropped: tuple[tuple[int, str], ...] = raw.dropped

    def require_mesh(self) -> None:
        """Raises InvalidInput where none has come with the frame."""
        if not self._has_mesh:
            raise InvalidInput(
                "this frame has no mesh: it answers a publisher, or its stream was opened with meshes=False, or with a "
                "part but 0"
            )

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh, decoded when it is asked for first."""
        self.require_mesh()
        return Mesh(self._raw.mesh())

    @cached_property
    def spray(self) -> NDArray[np.float32]:
        """(K, 3): places of the particles that the surface leaves out, where they were asked for by ``spray=True``."""
        return self._raw.spray()

    @cached_property
    def statistics(self) -> Statistics:
        """The server's figures of the frame as it was reconstructed, whatever a watcher asks for."""
        return Statistics.of(self._raw.statistics())

    @cached_property
    def attributes(self) -> Mapping[str, AttributeForm]:
        """All attributes of the surface by name, also those that were not asked for: forms and ranges."""
        return {name: AttributeForm(**form) for name, form in self._raw.attributes()}

    def __repr__(self) -> str:
        return f"<meniscus.Frame {self.index}: time {self.time:g}>"


class ParticleFrame:
    """Some or all of the particles of a frame that a simulator has pushed."""

    def __init__(self, raw: _meniscus.ParticleFrame) -> None:
        self._raw = raw
        self.index: int = raw.index
        self.run_id: int = raw.run_id
        self.time: float = raw.time
        self.frame_count: int = raw.frame_count  #: particles of the whole frame
        self.stride: int = raw.stride  #: of those, every stride-th is here, beginning with the first
        self.particle_radius: float = raw.particle_radius  #: of level 0, world units

    @cached_property
    def positions(self) -> NDArray[np.float32]:
        """(N, 3), world units, rounded to 65536 places along each side of the frame's bounding box."""
        return self._raw.positions()

    @cached_property
    def levels(self) -> Optional[NDArray[np.uint8]]:
        """(N,), or None."""
        return self._raw.levels()

    def __repr__(self) -> str:
        return f"<meniscus.ParticleFrame {self.index}: every {self.stride} of {self.frame_count} particles>"
