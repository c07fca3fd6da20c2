"""Surfaces."""

from __future__ import annotations

import base64
import html
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

import numpy as np

from . import _meniscus, exchange
from .errors import InvalidInput
from .named import Named
from .statistics import Statistics

if TYPE_CHECKING:  # from numpy 1.20 on
    from numpy.typing import NDArray


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

    @cached_property
    def vertices32(self) -> NDArray[np.float32]:
        """(N, 3), world units, as float32, which most renderers take: half the memory of ``vertices``, and made
        without them."""
        return self._raw.vertices32()

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
        """By name, what the vertices have of the particles' arrays, views: (N,), or (N, 3) or (N, 4). The name of an
        array in a file, such as "Temperature (K)", finds ``temperature__k_``, too."""
        return Named(self._raw.attributes())

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

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3), world units: the smallest and the largest corner of the box around it. Raises InvalidInput for an
        empty mesh, which has none."""
        if len(self.lattice) == 0:
            raise InvalidInput("this mesh is empty, and has no bounds")
        corners = np.stack([self.lattice.min(axis=0), self.lattice.max(axis=0)])
        box: NDArray[np.float64] = corners * (self.cell_size / 2.0**self.offset_bits)
        box.flags.writeable = False
        return box

    @cached_property
    def area(self) -> float:
        """Of all triangles, world units squared."""
        return self._raw.area()

    @cached_property
    def volume(self) -> float:
        """That the triangles enclose, world units cubed."""
        return self._raw.volume()

    def to_pyvista(self) -> Any:
        """A ``pyvista.PolyData`` with normals, attributes and, of the triangles, levels. Raises ImportError where
        there is no pyvista, here and below likewise."""
        return exchange.to_pyvista(self)

    def to_trimesh(self) -> Any:
        """A ``trimesh.Trimesh`` with normals, and attributes as ``vertex_attributes``."""
        return exchange.to_trimesh(self)

    def to_open3d(self) -> Any:
        """An ``open3d.t.geometry.TriangleMesh`` with normals, attributes and, of the triangles, levels."""
        return exchange.to_open3d(self)

    def png(
        self, width: int = 600, height: int = 400, *, color: str = "", up: str = "y", wireframe: bool = False
    ) -> bytes:
        """A picture, as ``meniscus picture`` draws it: the content of a PNG file.

        color: an attribute, or "velocity.x" of its components; "": water. up: "y" or "z". wireframe: lines colored by
        level. Raises InvalidInput for another attribute or axis, or more than 8192 pixels a side.
        """
        return self._raw.png(width, height, color, up, wireframe)

    def _repr_html_(self) -> str:
        """For notebooks: a picture, where that takes little time."""
        words = html.escape(repr(self).strip("<>"))
        if not 0 < len(self.triangles) <= _MOST_DRAWN:
            return f"<p>{words}</p>"
        picture = base64.b64encode(self.png()).decode()
        return f'<figure><img src="data:image/png;base64,{picture}" alt=""><figcaption>{words}</figcaption></figure>'

    def __copy__(self) -> Mesh:
        return Mesh(self._raw, self.statistics)

    def __deepcopy__(self, _: Any) -> Mesh:
        return self.__copy__()  # nothing in it can be changed

    def __reduce__(self) -> Any:
        return _restored, (self._raw.state(), self.statistics)

    def sha256(self) -> str:
        """The identity of the geometry, as ``mesh_sha256`` of the command line: 64 hexadecimal digits."""
        return self._raw.sha256()

    def bricks_sha256(self) -> str:
        """The identity of the geometry as a sum over its bricks: ``bricks_sha256`` of the command line.

        Where several processes have some bricks each, theirs add up to it, modulo 2**256, as 64 hexadecimal digits.
        """
        return self._raw.bricks_sha256()

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the mesh as its extension says: .ply, .obj, .vtk, .vtp, .vtu, .npz, .glb, .usda, .stl or .bricks.

        The file is the one that the command line writes, to the byte (.bricks: but for the times of its figures). It
        appears whole or not at all. Raises InvalidInput for another extension, or where nothing can be written.
        """
        self._raw.save(os.fspath(path))

    def __repr__(self) -> str:
        names = "".join(f", {name}" for name in self.attributes)
        return f"<meniscus.Mesh: {len(self.lattice)} vertices, {len(self.triangles)} triangles{names}>"


#: Triangles of a mesh that a notebook draws by itself: some tenths of a second.
_MOST_DRAWN = 2_000_000


def _restored(state: Mapping[str, Any], statistics: Optional[Statistics]) -> Mesh:
    """A mesh that was pickled. Raises InvalidInput for what no mesh can consist of."""
    return Mesh(_meniscus.restore_mesh(state), statistics)


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
