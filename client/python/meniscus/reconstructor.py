"""Surfaces in this process, without a server."""

from __future__ import annotations

import warnings
from typing import Any, Mapping, Optional, Sequence, Union

from . import _meniscus, arrays
from .errors import SurfaceWarning
from .mesh import DeviceMesh, Mesh
from .options import names_text, option_texts
from .statistics import Statistics
from .types import ArrayLike, Real, Whole


class Reconstructor:
    """Reconstructs the surfaces of frames, one after the other, and keeps its buffers between them.

    ``particle_radius`` is in world units, all other lengths are in particle radii. Keywords are the settings:

    preset              "smooth" (the defaults), "paper" or "splashsurf"; single ones override it
    attributes          "all", which is every array that the first frame brings, or names

    .. rows: settings

    cell_size           0.5: edge of a finest cell, in particle radii
    iso                 0.6: field value at the surface; with the field smooth less than 1, and 0.4 to 0.7 as a rule
    field               "smooth": function whose iso-surface is the fluid surface; "color", "density", "smooth"
    smoothness          6: with smooth, the widest support in particle radii, 5 to 7; more is smoother and slower
    spray               "keep": with smooth, particles without company become drops (keep), are left out (discard),
                        or are left out and listed beside the surface (points); "keep", "discard", "points"
    smoothing_length    2: with color or density, in particle radii; the kernel's support is twice that
    mode                "adaptive": three levels of grid, or the finest cell everywhere; "adaptive", "uniform"
    criterion           "curvature": how the level of a base cell is decided; "curvature", "count"
    tolerance           0.18: with curvature, how far the surface may depart from that of the finest cells, in
                        those; the default is that of the default field
    count_threshold     1: with count, particles per base cell that decide about level 3
    edge_points         "interpolate": how the point on an edge is found; "interpolate", "bisect"
    bisection_steps     5: with bisect, iterations on a finest edge
    normals             True: whether vertices get normals (the default)
    domain              None: crops the surface, world units

    .. end of rows

    A ``domain`` is ((x0, y0, z0), (x1, y1, z1)). Further keywords say how it is computed: ``backend`` ("auto", "cpu",
    "cuda"), ``threads`` (0: one for each processor), ``memory_limit`` (bytes, 0: none), ``device`` (index of the GPU),
    ``device_memory_limit``, ``keep_lattice`` (True: meshes keep what their bricks are made of, for Publisher.push()).

    Raises InvalidInput for settings that are out of range or not known. Calls of several threads take turns. The
    interpreter's lock is not held while a surface is computed, and Ctrl-C ends the computation.
    """

    def __init__(self, particle_radius: Real, *, attributes: Union[str, Sequence[str]] = "all", **options: Any) -> None:
        texts = option_texts({"particle_radius": particle_radius, **options})
        texts["attribute"] = names_text(attributes)
        self._raw = _meniscus.make_reconstructor(texts)

    @property
    def settings(self) -> dict[str, Any]:
        """All settings by name, with the defaults in force."""
        return self._raw.settings()

    @property
    def backend(self) -> str:
        """ "cpu" or "cuda"."""
        return self._raw.backend

    def reconstruct(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
    ) -> Mesh:
        """The surface of a frame.

        positions: (N, 3), world units, float32 or float64 (rounded to float32), or whatever numpy makes that of: an
        object with ``__array__``, or with DLPack on the CPU. levels: None, or (N,), 0 (finest) to 3: particles of
        level k have 2^k times the radius. attributes: arrays by name, (N,), (N, 3) or (N, 4) of float32 or uint8, or
        (N,) of int32 or uint32, which are ids: never averaged. On the backend "cuda" all of them may lie on the GPU
        instead (``__cuda_array_interface__``).

        Raises InvalidInput, LimitExceeded or DeviceError; the Reconstructor remains usable. What looks like a mistake
        is a SurfaceWarning.
        """
        return self._reconstruct(positions, levels, attributes, is_last=False)

    def reconstruct_on_device(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
    ) -> DeviceMesh:
        """Reconstructs a frame, but the mesh stays on the GPU. Raises InvalidInput on the backend "cpu"."""
        if arrays.is_on_gpu(positions):
            raw, figures = self._raw.device_mesh_from_device(*arrays.device_frame(positions, levels, attributes))
        else:
            raw, figures = self._raw.device_mesh(*arrays.frame(positions, levels, attributes))
        return DeviceMesh(raw, _told(figures, callers=2))

    def coarser(self, max_level: Whole) -> Mesh:
        """The surface of the last frame once more, with no cell finer than ``max_level``, 1 to 3: fewer triangles, as
        closed. Nothing is sampled again."""
        return Mesh(self._raw.coarser(max_level))

    def release_memory(self) -> None:
        """Gives the buffers back; the next frame takes them again."""
        self._raw.release_memory()

    def _reconstruct(self, positions: Any, levels: Any, attributes: Optional[Mapping[str, Any]], is_last: bool) -> Mesh:
        """is_last: whether no other frame follows, so that memory is given back while the mesh is made."""
        if arrays.is_on_gpu(positions):
            raw, figures = self._raw.reconstruct_from_device(*arrays.device_frame(positions, levels, attributes))
        else:
            raw, figures = self._raw.reconstruct(*arrays.frame(positions, levels, attributes), is_last=is_last)
        return Mesh(raw, _told(figures, callers=3))


def reconstruct(
    positions: ArrayLike,
    particle_radius: Real,
    *,
    levels: Optional[ArrayLike] = None,
    attributes: Optional[Mapping[str, ArrayLike]] = None,
    **options: Any,
) -> Mesh:
    """The surface of one frame of particles, computed in this process.

    The arrays are those of Reconstructor.reconstruct(), and the further keywords are those of Reconstructor: the
    settings and where to compute. Every attribute that is given becomes one of the mesh. For several frames, a
    Reconstructor that is kept is faster; for one, this takes less memory.
    """
    return Reconstructor(particle_radius, **options)._reconstruct(positions, levels, attributes, is_last=True)


def _told(figures: Mapping[str, Any], callers: int) -> Statistics:
    """Warns at the user's line. callers: the number of functions from this one up to the user's."""
    statistics = Statistics.of(figures)
    for warning in statistics.warnings:
        warnings.warn(warning.text, SurfaceWarning, stacklevel=callers + 1)
    return statistics
