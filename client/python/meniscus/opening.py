"""Streams, publishers and watchers, opened by the keywords of Client and Session."""

from __future__ import annotations

from typing import Any, Callable, Optional, TypeVar

from . import _meniscus
from .errors import InvalidInput
from .options import AttributeRequest, attribute_text, option_texts
from .publisher import Publisher
from .receiving import Frames, Handler
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
    has_meshes = meshes and not options.get("part")  # they come to part 0 alone
    return _opened(lambda raw: Stream(raw, has_meshes), open_raw, texts, on_reconnect)


def open_publisher(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.Publisher],
    *,
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> Publisher:
    return _opened(Publisher, open_raw, option_texts(options), on_reconnect)


def open_watcher(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.Watcher],
    *,
    attributes: AttributeRequest = "all",
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> Watcher:
    texts = option_texts(options)
    texts["attribute"] = attribute_text(attributes)
    return _opened(Watcher, open_raw, texts, on_reconnect)


def open_particle_watcher(
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], _meniscus.ParticleWatcher],
    *,
    on_reconnect: Optional[ReconnectHandler] = None,
    **options: Any,
) -> ParticleWatcher:
    return _opened(ParticleWatcher, open_raw, option_texts(options), on_reconnect)


Raw = TypeVar("Raw")
Source = TypeVar("Source", bound=Frames[Any])


def _opened(
    make: Callable[[Raw], Source],
    open_raw: Callable[[dict[str, str], Optional[ReconnectHandler]], Raw],
    texts: dict[str, str],
    on_reconnect: Optional[ReconnectHandler],
) -> Source:
    """What is made of the C++ side's object, which calls the handler until the end of it."""
    handler = _handler(on_reconnect)
    source = make(open_raw(texts, handler))
    source._handler = handler
    return source


def _handler(on_reconnect: Optional[ReconnectHandler]) -> Optional[Handler]:
    if on_reconnect is None:
        return None
    if not callable(on_reconnect):
        raise InvalidInput(
            f"on_reconnect is {on_reconnect!r}, must be a function of attempt, connected, reason and seconds left"
        )
    return Handler(on_reconnect)
