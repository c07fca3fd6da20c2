"""A session that its owner holds, and that ends with it."""

from __future__ import annotations

from typing import Any, Callable, Optional

from . import _meniscus
from .errors import ForkedError, InvalidInput, ServerError
from .information import SessionInfo
from .options import AttributeRequest, attribute_text, option_texts
from .receiving import Handler
from .statistics import Statistics
from .stream import Stream
from .watcher import ParticleWatcher, Watcher

#: Called at each attempt to go on after a connection broke, in a thread of the library's, which waits for it: the
#: attempt's number, whether it has succeeded (otherwise it begins now), why, and seconds until it is given up.
ReconnectHandler = Callable[[int, bool, str, float], None]


class Session:
    """A session on the server, from Client.session().

    It ends with the ``with`` block, or with this object, if it was created by it; one that was there before stays.
    """

    def __init__(self, raw: _meniscus.Session) -> None:
        self._raw = raw

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


def open_stream(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.Stream],
    *,
    meshes: bool = True,
    attributes: AttributeRequest = "all",
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> Stream:
    texts = option_texts({"meshes": meshes, **options})
    texts["attribute"] = attribute_text(attributes)
    handler = _handler(on_reconnect)
    stream = Stream(open_raw(texts, handler), meshes)
    stream._handler = handler
    return stream


def open_watcher(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.Watcher],
    *,
    attributes: AttributeRequest = "all",
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> Watcher:
    texts = option_texts(options)
    texts["attribute"] = attribute_text(attributes)
    handler = _handler(on_reconnect)
    watcher = Watcher(open_raw(texts, handler))
    watcher._handler = handler
    return watcher


def open_particle_watcher(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.ParticleWatcher],
    *,
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> ParticleWatcher:
    handler = _handler(on_reconnect)
    watcher = ParticleWatcher(open_raw(option_texts(options), handler))
    watcher._handler = handler
    return watcher


def _handler(on_reconnect: Optional[ReconnectHandler]) -> Optional[Handler]:
    if on_reconnect is None:
        return None
    if not callable(on_reconnect):
        raise InvalidInput(
            f"on_reconnect is {on_reconnect!r}, must be a function of attempt, connected, reason and seconds left"
        )
    return Handler(on_reconnect)
