"""Views of a session that another program feeds."""

from __future__ import annotations

from . import _meniscus
from .frame import Frame, ParticleFrame
from .receiving import Frames


class Watcher(Frames[Frame]):
    """Receives a session's meshes, always the newest; from Client.watch() or Session.watch().

    Frames that came while the caller was busy are skipped by the server.
    """

    def __init__(self, raw: _meniscus.Watcher) -> None:
        super().__init__(raw, Frame)
        self._watcher = raw

    @property
    def end_reason(self) -> str:
        """Why the session ended, once ``ended``, such as "it was deleted". "": it has not, or is not told."""
        return self._watcher.end_reason()


class ParticleWatcher(Frames[ParticleFrame]):
    """Receives a session's particles, always the newest; from Client.watch_particles()."""

    def __init__(self, raw: _meniscus.ParticleWatcher) -> None:
        super().__init__(raw, ParticleFrame)


class RecordingReader(Frames[Frame]):
    """Reads frames that a server has recorded, in order; from Client.read_recording()."""

    def __init__(self, raw: _meniscus.RecordingReader) -> None:
        super().__init__(raw, Frame)
