"""Files of particles."""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

import numpy as np

from . import _meniscus
from .errors import InvalidInput, SurfaceWarning
from .named import Named

if TYPE_CHECKING:  # from numpy 1.20 on
    from numpy.typing import NDArray


@dataclass(frozen=True, repr=False)
class Particles:
    """A frame that was read from a file."""

    positions: NDArray[np.float32]  #: (N, 3), as the file has them
    levels: Optional[NDArray[np.uint8]]  #: (N,)
    attributes: Mapping[str, NDArray[Any]]  #: by name: the other values that the file has of each particle
    left_out: tuple[str, ...]  #: a line for each array of the file that has no place here, with the reason
    #: By name, what the file calls an array where that is another text, as "Temperature (K)" of ``temperature__k_``.
    #: It finds the array among the attributes, too.
    labels: Mapping[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.positions)

    def __repr__(self) -> str:
        return f"<Particles: {', '.join([f'{len(self):,}', *self.attributes])}>"


def read_particles(path: Union[str, os.PathLike[str]], *, max_bytes: Optional[int] = None) -> Particles:
    """Reads a frame: .vtk, .vtu, .vtp, .ply, .npy, .npz, .bgeo, .bgeo.gz, .h5, .hdf5, .h5part, .bi4, .json, .xyz.

    ``max_bytes`` bounds what the file takes with all that it makes grow: by default half of the machine's memory, 8 GiB
    at most. Nothing is read but the file itself. Raises InvalidInput, in one line with the file, the place and what was
    expected; LimitExceeded for a larger file. A mesh, whose corners become particles, is a SurfaceWarning.
    """
    try:
        positions, levels, arrays, left_out, warning = _meniscus.read_particles(os.fspath(path), max_bytes)
    except InvalidInput as error:
        name = os.fsdecode(path)
        if os.path.exists(path) or not (found := _PATTERN.search(name)):
            raise
        one = f"{name[:found.start()]}{{number{_width(found[0])}}}{name[found.end():]}"
        raise InvalidInput(f"{error}; a call reads one file: write f{one!r} in a loop over the numbers") from None
    if warning is not None:
        warnings.warn(f"{os.fsdecode(path)}: {warning}", SurfaceWarning, stacklevel=2)
    values = Named({name: array for name, array, _ in arrays})
    labels = {name: label for name, _, label in arrays if label != name}
    return Particles(positions, levels, values, tuple(left_out), labels)


#: What other programs have in place of a frame's number.
_PATTERN = re.compile(r"\*+|%\d*d|#+")


def _width(pattern: str) -> str:
    """Of numbers with zeros before them: ":04" of "%04d" and "####"."""
    digits = pattern.strip("%d") if pattern.startswith("%") else f"0{len(pattern)}" if pattern.startswith("#") else ""
    return f":{digits}" if digits else ""


def particle_extensions() -> tuple[str, ...]:
    """The extensions of the files that read_particles() reads, with their dots."""
    return tuple(_meniscus.particle_extensions())


def mesh_extensions() -> tuple[str, ...]:
    """The extensions of the files that Mesh.save() writes, with their dots."""
    return tuple(_meniscus.mesh_extensions())
