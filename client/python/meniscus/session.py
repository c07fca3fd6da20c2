"""A session that its owner holds, and that ends with it."""

from __future__ import annotations

from typing import Any

from . import _meniscus
from .errors import ForkedError, ServerError
from .information import SessionInfo
from .opening import open_particle_watcher, open_publisher, open_stream, open_watcher
from .publisher import Publisher
from .statistics import Statistics
from .stream import Stream
from .watcher import ParticleWatcher, Watcher


class Session:
    """A session on the server, from Client.session().

    It ends with the ``with`` block, or with this object, if it was created by it; one that was there before stays.
    """

    def __init__(self, raw: _meniscus.Session, viewer: str = "") -> None:
        self._raw = raw
        self.viewer = viewer  #: the page of the server's viewer; "": not known

    @property
    def id(self) -> str:
        """A UUID, for watchers."""
        return self._raw.id

    @property
    def is_owned(self) -> bool:
        """Whether the session ends with this object."""
        return self._raw.is_owned

    def info(self) -> SessionInfo:
        """The session's description and state. Raises ServerError (not_found) if it has ended."""
        return session_info(self._raw.info())

    def stream(self, **options: Any) -> Stream:
        """Opens the session's stream; a session has one at a time. The keywords are those of Client.stream()."""
        return open_stream(self._raw.stream, **options)

    def publish(self, **options: Any) -> Publisher:
        """Opens a publisher of surfaces that are made here; a session has particles or surfaces, and not both. The
        keywords are those of Client.publish()."""
        return open_publisher(self._raw.publish, **options)

    def watch(self, **options: Any) -> Watcher:
        """Watches the session as Client.watch() does."""
        return open_watcher(self._raw.watch, **options)

    def watch_particles(self, **options: Any) -> ParticleWatcher:
        """Watches the session's particles as Client.watch_particles() does."""
        return open_particle_watcher(self._raw.watch_particles, **options)

    def leave(self) -> None:
        """The session stays when this object goes; an ephemeral one still ends soon after its stream."""
        self._raw.leave()

    def end(self) -> None:
        """Ends the session now, its streams and watchers with it, if it is owned."""
        self._raw.end()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *raised: object) -> None:
        try:
            self.end()
        except ForkedError:
            pass  # there it is the parent's
        except ServerError:
            if raised[0] is None:
                raise

    def __repr__(self) -> str:
        return f"<meniscus.Session {self.id}>"


def session_info(fields: dict[str, Any]) -> SessionInfo:
    last = fields.pop("last_frame")
    return SessionInfo(**fields, last_frame=None if last is None else Statistics.of(last))
