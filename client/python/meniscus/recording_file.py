"""Surfaces on this disk, encoded as they travelled."""

from __future__ import annotations

import os
from typing import Any, Iterator, Optional, Union

from . import _meniscus
from .errors import InvalidInput
from .frame import Frame


def read_bricks(path: Union[str, os.PathLike[str]], *, max_bytes: Optional[int] = None) -> Frame:
    """Reads a .bricks file, as ``meniscus watch`` and Mesh.save() write it. Raises InvalidInput for anything else."""
    return Frame(_meniscus.read_bricks(os.fspath(path), max_bytes))


class RecordingFile:
    """A recording that ``meniscusd --record`` has kept: the frames of a session, those with a mesh.

    Of a file that is still being written, or was cut, it has the frames that are whole. ``len()`` is their number;
    ``for frame in file`` reads one after the other. Raises InvalidInput for what is no recording.
    """

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        self.path = os.fspath(path)
        self._raw = _meniscus.open_recording_file(self.path)
        frames = self._raw.frames()
        self.indices: tuple[int, ...] = tuple(index for index, _ in frames)  #: as the frames were pushed, rising
        self.times: tuple[float, ...] = tuple(time for _, time in frames)  #: of the simulation

    @property
    def session_id(self) -> str:
        return self._raw.session_id

    @property
    def name(self) -> str:
        """The session's name; "" where it had none."""
        return self._raw.name

    @property
    def settings(self) -> dict[str, Any]:
        """The session's settings by name."""
        return self._raw.settings()

    @property
    def cut_bytes(self) -> int:
        """Bytes at the end of the file that are no whole frame."""
        return self._raw.cut_bytes

    def frame(self, place: int) -> Frame:
        """The frame at the place, 0 to len() - 1. Raises InvalidInput if it is damaged, or not there."""
        if not 0 <= place < len(self):
            raise InvalidInput(f"{self.path}: there is no frame at the place {place}, but at 0 to {len(self) - 1}")
        return Frame(self._raw.frame(place))

    def __len__(self) -> int:
        return len(self.indices)

    def __iter__(self) -> Iterator[Frame]:
        return (self.frame(place) for place in range(len(self)))

    def __repr__(self) -> str:
        return f"<meniscus.RecordingFile {self.path}: {len(self)} frames>"
