"""The descriptions of a server, of its sessions and of its recordings."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any, Mapping, Optional

from .statistics import Statistics


@dataclass(frozen=True, repr=False)
class ServerInfo:
    """A server, and the limits that it keeps."""

    version: str
    backend: str  #: "cpu" or "cuda"
    device: str
    backend_reason: str
    threads: int
    publishes: bool  #: whether sessions may be published
    checks_published: bool  #: whether surfaces that were made elsewhere are refused unless they are closed
    limits: Mapping[str, float]  #: by name, as in "max_particles_per_frame"; 0: none

    def __repr__(self) -> str:
        return f"<ServerInfo {self.version}, {self.backend}, {self.threads} threads>"


@dataclass(frozen=True, repr=False)
class SessionInfo:
    """A session, and what it is doing."""

    id: str
    owner: str  #: its maker; "" where names are not asked for
    settings: Mapping[str, Any]  #: with the defaults in force
    name: str
    up_axis: str  #: "x", "y", "z" or "unspecified"
    length_unit: str  #: such as "m"; "": not said
    ephemeral: bool
    published: bool  #: as files of the server's HTTP port
    created_at: datetime  #: UTC
    uploading: bool
    watchers: int
    waits_for: str  #: "nothing", "device", "bytes_in_flight" or "something_else"
    waits_for_session: str
    frames: int
    frames_dropped: int
    frames_skipped: int
    last_frame_index: Optional[int]
    last_frame: Optional[Statistics]

    def __repr__(self) -> str:
        particles = "" if self.last_frame is None else f", {self.last_frame.particles:,} particles"
        state = "live" if self.uploading else "at rest"
        return f"<Session {_shown(self.name, self.id)} {state}, {_frames(self.frames)}{particles}>"


@dataclass(frozen=True, repr=False)
class RecordingInfo:
    """Frames of a session that the server has kept."""

    session_id: str
    number: int  #: of the session's recordings, from 1
    owner: str
    name: str  #: of the session, and the two that follow
    up_axis: str
    length_unit: str
    started_at: datetime  #: UTC
    frames: int  #: those with a mesh, here and below
    first_frame_index: Optional[int]
    last_frame_index: Optional[int]
    bytes: int
    being_written: bool
    damaged: bool  #: behind the last of these frames

    def __repr__(self) -> str:
        state = ", being written" if self.being_written else ", damaged" if self.damaged else ""
        name = _shown(self.name, self.session_id)
        return f"<Recording {self.number} of {name}, {_frames(self.frames)}, {self.bytes:,} bytes{state}>"


def _frames(count: int) -> str:
    return f"{count} frame{'' if count == 1 else 's'}"


def _shown(name: str, session_id: str) -> str:
    return f'"{name}"' if name else session_id
