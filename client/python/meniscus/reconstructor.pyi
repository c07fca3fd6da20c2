# The keywords of reconstructor.py, one by one; deploy/document-rows writes those of the marked places.

from typing import Any, Literal, Mapping, Optional, Sequence, Union

from .mesh import DeviceMesh, Mesh
from .types import ArrayLike, Box, Real, Whole

class Reconstructor:
    def __init__(
        self,
        particle_radius: Real,
        *,
        attributes: Union[str, Sequence[str]] = "all",
        # rows: preset
        preset: Optional[Literal["smooth", "paper", "splashsurf"]] = "smooth",
        # end of rows
        # rows: settings
        cell_size: Optional[Real] = 0.5,
        iso: Optional[Real] = 0.6,
        field: Optional[Literal["color", "density", "smooth"]] = "smooth",
        smoothness: Optional[Whole] = 6,
        spray: Optional[Literal["keep", "discard", "points"]] = "keep",
        smoothing_length: Optional[Real] = 2,
        mode: Optional[Literal["adaptive", "uniform"]] = "adaptive",
        criterion: Optional[Literal["curvature", "count"]] = "curvature",
        tolerance: Optional[Real] = 0.18,
        count_threshold: Optional[Whole] = 1,
        edge_points: Optional[Literal["interpolate", "bisect"]] = "interpolate",
        bisection_steps: Optional[Whole] = 5,
        normals: Optional[bool] = True,
        domain: Optional[Box] = None,
        # end of rows
        # rows: backend options
        backend: Optional[Literal["auto", "cpu", "cuda"]] = "auto",
        threads: Optional[Whole] = 0,
        memory_limit: Optional[Whole] = 0,
        device: Optional[Whole] = 0,
        device_memory_limit: Optional[Whole] = 0,
        keep_lattice: Optional[bool] = False,
        # end of rows
    ) -> None: ...
    @property
    def settings(self) -> dict[str, Any]: ...
    @property
    def backend(self) -> str: ...
    def reconstruct(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
    ) -> Mesh: ...
    def reconstruct_on_device(
        self,
        positions: ArrayLike,
        *,
        levels: Optional[ArrayLike] = None,
        attributes: Optional[Mapping[str, ArrayLike]] = None,
    ) -> DeviceMesh: ...
    def coarser(self, max_level: Whole) -> Mesh: ...
    def release_memory(self) -> None: ...

def reconstruct(
    positions: ArrayLike,
    particle_radius: Real,
    *,
    levels: Optional[ArrayLike] = None,
    attributes: Optional[Mapping[str, ArrayLike]] = None,
    # rows: preset
    preset: Optional[Literal["smooth", "paper", "splashsurf"]] = "smooth",
    # end of rows
    # rows: settings
    cell_size: Optional[Real] = 0.5,
    iso: Optional[Real] = 0.6,
    field: Optional[Literal["color", "density", "smooth"]] = "smooth",
    smoothness: Optional[Whole] = 6,
    spray: Optional[Literal["keep", "discard", "points"]] = "keep",
    smoothing_length: Optional[Real] = 2,
    mode: Optional[Literal["adaptive", "uniform"]] = "adaptive",
    criterion: Optional[Literal["curvature", "count"]] = "curvature",
    tolerance: Optional[Real] = 0.18,
    count_threshold: Optional[Whole] = 1,
    edge_points: Optional[Literal["interpolate", "bisect"]] = "interpolate",
    bisection_steps: Optional[Whole] = 5,
    normals: Optional[bool] = True,
    domain: Optional[Box] = None,
    # end of rows
    # rows: backend options
    backend: Optional[Literal["auto", "cpu", "cuda"]] = "auto",
    threads: Optional[Whole] = 0,
    memory_limit: Optional[Whole] = 0,
    device: Optional[Whole] = 0,
    device_memory_limit: Optional[Whole] = 0,
    keep_lattice: Optional[bool] = False,
    # end of rows
) -> Mesh: ...
