"""Surfaces."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _meniscus
from .statistics import Statistics


class Mesh:
    """A closed, oriented triangle mesh.

    Its arrays are views of the library's memory, not copies, where that is said; they are read-only and keep the mesh
    alive. ``copy()`` one to change it.
    """

    def __init__(self, raw: _meniscus.Mesh, statistics: Optional[Statistics] = None) -> None:
        self._raw = raw
        #: Figures of the reconstruction; None of a mesh that came from a server, whose frame has them.
        self.statistics = statistics

    @cached_property
    def vertices(self) -> NDArray[np.float64]:
        """(N, 3), world units: exact but for one rounding; made when it is asked for first."""
        return self._raw.vertices()

    @property
    def lattice(self) -> NDArray[np.int32]:
        """(N, 3), a view: the vertices in units of ``cell_size / 2**offset_bits``, exact."""
        return self._raw.lattice

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(M, 3), a view: indices of vertices, counter-clockwise seen from outside."""
        return self._raw.triangles

    @property
    def normals(self) -> Optional[NDArray[np.float32]]:
        """(N, 3), a view: unit length, outward; None with ``normals=False``."""
        return self._raw.normals

    @cached_property
    def levels(self) -> NDArray[np.uint8]:
        """(M,): the level of grid of each triangle: 1, 2, 3 (finest), or 0 for crack filling."""
        return self._raw.levels()

    @cached_property
    def attributes(self) -> Mapping[str, NDArray[Any]]:
        """By name, what the vertices have of the particles' arrays, views: (N,), or (N, 3) or (N, 4)."""
        return dict(self._raw.attributes())

    @property
    def spray(self) -> NDArray[np.float32]:
        """(K, 3), a view: places of the particles that the surface leaves out, with ``spray="points"``."""
        return self._raw.spray

    @property
    def cell_size(self) -> float:
        """Edge of a finest cell, world units."""
        return self._raw.cell_size

    @property
    def offset_bits(self) -> int:
        """Vertices lie on multiples of ``cell_size / 2**offset_bits``."""
        return self._raw.offset_bits

    def sha256(self) -> str:
        """The identity of the geometry, as ``mesh_sha256`` of the command line: 64 hexadecimal digits."""
        return self._raw.sha256()

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the mesh as its extension says: .ply, .obj, .vtk, .vtp, .vtu, .npz, .glb, .usda, .stl or .bricks.

        The file is the one that the command line writes, to the byte (.bricks: but for the times of its figures). It
        appears whole or not at all. Raises InvalidInput for another extension, or where nothing can be written.
        """
        self._raw.save(os.fspath(path))

    def __repr__(self) -> str:
        names = "".join(f", {name}" for name in self.attributes)
        return f"<meniscus.Mesh: {len(self.lattice)} vertices, {len(self.triangles)} triangles{names}>"


class DeviceArray:
    """An array in the memory of a GPU, for CuPy, Warp, Numba and PyTorch (``__cuda_array_interface__``)."""

    def __init__(self, interface: Mapping[str, Any], owner: object) -> None:
        self.__cuda_array_interface__ = dict(interface)
        self._owner = owner


class DeviceMesh:
    """A mesh that stays on the GPU, in memory of its Reconstructor.

    It is complete on every stream, and valid until the Reconstructor's next call: its arrays raise Error from then on.
    What was made of them by then, and is still read, must be copied before.
    """

    def __init__(self, raw: _meniscus.DeviceMesh, statistics: Statistics) -> None:
        self._raw = raw
        self.statistics = statistics
        self.attribute_names: tuple[str, ...] = raw.attribute_names

    def _array(self, name: str) -> DeviceArray:
        return DeviceArray(self._raw.interface(name), self._raw)

    @property
    def lattice(self) -> DeviceArray:
        """(N, 3) int32: vertices in units of ``cell_size / 2**offset_bits``."""
        return self._array("lattice")

    @property
    def triangles(self) -> DeviceArray:
        """(M, 3) uint32."""
        return self._array("triangles")

    @property
    def normals(self) -> DeviceArray:
        """(N, 3) float32."""
        return self._array("normals")

    def attribute(self, name: str) -> DeviceArray:
        """(N,), (N, 3) or (N, 4)."""
        return self._array("attribute " + name)

    @property
    def cell_size(self) -> float:
        return self._raw.cell_size

    @property
    def offset_bits(self) -> int:
        return self._raw.offset_bits

    @property
    def device(self) -> int:
        """Index of the GPU."""
        return self._raw.device
