"""Streams, publishers and watchers, opened by the keywords of Client and Session."""

from __future__ import annotations

from typing import Any, Callable, Optional

from . import _meniscus
from .errors import InvalidInput
from .options import AttributeRequest, attribute_text, option_texts
from .publisher import Publisher
from .receiving import Handler
from .stream import Stream
from .watcher import ParticleWatcher, Watcher

#: Called at each attempt to go on after a connection broke, in a thread of the library's, which waits for it: the
#: attempt's number, whether it has succeeded (otherwise it begins now), why, and seconds until it is given up.
ReconnectHandler = Callable[[int, bool, str, float], None]


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
    stream = Stream(open_raw(texts, handler), meshes and not options.get("part"))  # meshes come to part 0 alone
    stream._handler = handler
    return stream


def open_publisher(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.Publisher],
    *,
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> Publisher:
    handler = _handler(on_reconnect)
    publisher = Publisher(open_raw(option_texts(options), handler))
    publisher._handler = handler
    return publisher


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
