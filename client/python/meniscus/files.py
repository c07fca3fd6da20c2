"""Files of particles."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _meniscus


@dataclass(frozen=True)
class Particles:
    """A frame that was read from a file."""

    positions: NDArray[np.float32]  #: (N, 3), as the file has them
    levels: Optional[NDArray[np.uint8]]  #: (N,)
    attributes: Mapping[str, NDArray[Any]]  #: by name: the other values that the file has of each particle
    left_out: tuple[str, ...]  #: a line for each array of the file that has no place here, with the reason

    def __len__(self) -> int:
        return len(self.positions)


def read_particles(path: Union[str, os.PathLike[str]], *, max_bytes: Optional[int] = None) -> Particles:
    """Reads a frame: .vtk, .vtu, .vtp, .ply, .npy, .npz, .bgeo, .bgeo.gz, .h5, .hdf5, .h5part, .bi4, .json, .xyz.

    ``max_bytes`` bounds what the file takes with all that it makes grow: by default half of the machine's memory, 8 GiB
    at most. Nothing is read but the file itself. Raises InvalidInput, in one line with the
    file, the place and what was expected; LimitExceeded for a larger file.
    """
    positions, levels, named, left_out = _meniscus.read_particles(os.fspath(path), max_bytes)
    return Particles(positions, levels, dict(named), tuple(left_out))


def particle_extensions() -> tuple[str, ...]:
    """The extensions of the files that read_particles() reads, with their dots."""
    return tuple(_meniscus.particle_extensions())


def mesh_extensions() -> tuple[str, ...]:
    """The extensions of the files that Mesh.save() writes, with their dots."""
    return tuple(_meniscus.mesh_extensions())
