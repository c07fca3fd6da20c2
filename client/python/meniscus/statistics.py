"""Figures of one reconstruction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping


@dataclass(frozen=True)
class FrameWarning:
    """A probable mistake in a frame or its settings. The frame was reconstructed as asked."""

    code: str  #: such as "radius_too_small"
    value: float  #: what was found
    limit: float  #: what it is held against
    text: str  #: the same in words, with what to do


@dataclass(frozen=True, repr=False)
class Statistics:
    """Counts, times and memory of one frame. Lengths are in world units, times in seconds."""

    # rows: statistics
    particles: int  #: particles of the frame
    spray_particles: int  #: particles without company, whatever the setting spray makes of them
    vertices: int  #: vertices of the mesh
    triangles: int  #: triangles of the mesh
    triangles_by_level: Mapping[str, int]  #: triangles by level of grid
    base_cells_by_level: tuple[int, int, int]  #: cells of the surface band of levels 1, 2, 3
    vertices_without_particles: int  #: vertices that no particle is near: their attributes are 0
    volume: float  #: volume that the mesh encloses, exact until it is rounded here, world units cubed
    particle_volume: float  #: volume of the frame's particles: the sum of (2 r)^3, world units cubed
    field_evaluations: int  #: points at which the field was summed
    stage_seconds: Mapping[str, float]  #: time of each of the paper's steps, s
    download_seconds: float  #: time of copies from the GPU, s
    total_seconds: float  #: time of the reconstruction, s
    peak_bytes: int  #: most memory of the reconstruction and the mesh, bytes
    allocations: int  #: allocations for this frame; 0 once warm
    device_bytes: int  #: memory on the GPU, but for that of CUDA itself, bytes
    device_peak_bytes: int  #: most memory on the GPU, bytes
    backend: str  #: "cpu" or "cuda"
    threads: int  #: worker threads
    warnings: tuple[FrameWarning, ...]  #: what looks like a mistake
    # end of rows

    # The figures of a frame from a server:
    # rows: frame statistics
    encode_seconds: float = 0.0  #: time of the encoding, s
    latency_seconds: float = 0.0  #: time from the frame's last byte to the end of its encoding, s
    encoded_bytes: int = 0  #: all bricks as sent, bytes
    # end of rows

    def __repr__(self) -> str:
        codes = "".join(f", {warning.code}" for warning in self.warnings)
        shown = f"{self.particles:,} particles, {self.triangles:,} triangles, {self.total_seconds:.3g} s{codes}"
        return f"<Statistics: {shown}>"

    @classmethod
    def of(cls, figures: Mapping[str, Any]) -> Statistics:
        """The statistics of the figures that come from C++."""
        told: dict[str, Any] = dict(figures)
        told["warnings"] = tuple(FrameWarning(**warning) for warning in told["warnings"])
        return cls(**told)
