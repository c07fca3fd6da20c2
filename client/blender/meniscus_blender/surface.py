"""A surface in the arrays that Blender takes: float32 and int32, next to each other."""

from dataclasses import dataclass, field
from typing import Mapping, Optional

import numpy as np


@dataclass(frozen=True)
class Surface:
    """Arrays belong to the surface alone: they may be kept and handed to another thread."""

    vertices: np.ndarray  #: (N, 3) float32
    triangles: np.ndarray  #: (M, 3) int32
    normals: Optional[np.ndarray] = None  #: (N, 3) float32
    attributes: Mapping[str, np.ndarray] = field(default_factory=dict)  #: (N,) or (N, k); float32, uint8, int32, uint32
    warnings: tuple = ()  #: lines
    fitting_radius: float = 0.0  #: the particle radius that a warning proposes; 0: none
    particles: int = 0

    def text(self):
        """The counts, for people."""
        return f"{len(self.triangles):,} triangles of {self.particles:,} particles"


def surface_of(mesh, statistics, normals=False):
    """The surface of a meniscus.Mesh. Lattice coordinates become float32 by one rounding."""
    radii = [warning.limit for warning in statistics.warnings if warning.code.startswith("radius_too_")]
    return Surface(
        np.ascontiguousarray(mesh.vertices, np.float32),
        mesh.triangles.astype(np.int32),
        np.array(mesh.normals, np.float32) if normals and mesh.normals is not None else None,
        {name: np.array(values) for name, values in mesh.attributes.items()},
        tuple(warning.text for warning in statistics.warnings),
        float(radii[0]) if radii else 0.0,
        int(statistics.particles),
    )
