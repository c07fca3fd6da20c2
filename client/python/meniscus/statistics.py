"""Figures of one reconstruction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping


@dataclass(frozen=True)
class FrameWarning:
    """What a frame's owner surely did not mean. The frame was reconstructed as asked."""

    code: str  #: such as "radius_too_small"
    value: float  #: what was found
    limit: float  #: what it is held against
    text: str  #: the same in words, with what to do


@dataclass(frozen=True)
class Statistics:
    """Counts, times and memory of one frame. Lengths are in world units, times in seconds."""

    particles: int
    vertices: int
    triangles: int
    triangles_by_level: Mapping[str, int]  #: "level1", "level2", "level3", "crack"
    spray_particles: int  #: particles without company, whatever the setting ``spray`` makes of them
    vertices_without_particles: int  #: those that no particle is near: their attributes are 0
    volume: float  #: enclosed by the mesh
    particle_volume: float  #: of the frame: the sum of (2 r)^3
    base_cells_by_level: tuple[int, int, int]  #: cells of the surface band of levels 1, 2, 3
    field_evaluations: int  #: points at which the field was summed
    stage_seconds: Mapping[str, float]  #: of the paper's steps, "register_particles" to "fill_cracks"
    total_seconds: float
    download_seconds: float  #: copies from the GPU
    peak_bytes: int
    allocations: int  #: made for this frame; 0 once warm
    device_bytes: int
    device_peak_bytes: int
    backend: str  #: "cpu" or "cuda"
    threads: int
    warnings: tuple[FrameWarning, ...]
    encode_seconds: float = 0.0  #: of a frame from a server, here and below
    latency_seconds: float = 0.0  #: from the frame's last byte to the end of its encoding
    encoded_bytes: int = 0

    @classmethod
    def of(cls, figures: Mapping[str, Any]) -> Statistics:
        """Of what the C++ side tells."""
        told: dict[str, Any] = dict(figures)
        told["warnings"] = tuple(FrameWarning(**warning) for warning in told["warnings"])
        return cls(**told)
