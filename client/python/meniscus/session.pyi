# The keywords of session.py, one by one; deploy/document-rows writes those of the marked places.

from typing import Any, Literal, Optional

from . import _meniscus
from .information import SessionInfo
from .opening import ReconnectHandler
from .options import AttributeRequest
from .publisher import Publisher
from .stream import Stream
from .types import Box, Point, Real, Whole
from .watcher import ParticleWatcher, Watcher

class Session:
    viewer: str
    def __init__(self, raw: _meniscus.Session, viewer: str = "") -> None: ...
    @property
    def id(self) -> str: ...
    @property
    def is_owned(self) -> bool: ...
    def info(self) -> SessionInfo: ...
    def stream(
        self,
        *,
        attributes: AttributeRequest = "all",
        attribute_bits: Optional[Whole] = 8,
        spray: Optional[bool] = False,
        on_reconnect: Optional[ReconnectHandler] = None,
        # rows: stream options
        meshes: Optional[bool] = True,
        normal_bits: Optional[Whole] = 8,
        normals_by: Optional[Literal["server", "receiver"]] = "server",
        codec: Optional[Literal["entropy", "packed", "draco"]] = None,
        waiting_limit: Optional[Whole] = 0,
        policy: Optional[Literal["every-frame", "latest", "every-nth"]] = "every-frame",
        nth: Optional[Whole] = 1,
        parts: Optional[Whole] = 1,
        part: Optional[Whole] = 0,
        run: Optional[Whole] = 0,
        reconnect: Optional[Real] = 0,
        route_check: Optional[Real] = 2,
        # end of rows
    ) -> Stream: ...
    def publish(
        self,
        *,
        attribute_bits: Optional[Whole] = 8,
        on_reconnect: Optional[ReconnectHandler] = None,
        # rows: publisher options
        codec: Optional[Literal["entropy", "packed", "draco"]] = "packed",
        normal_bits: Optional[Whole] = 8,
        waiting_limit: Optional[Whole] = 0,
        policy: Optional[Literal["every-frame", "latest", "every-nth"]] = "every-frame",
        nth: Optional[Whole] = 1,
        parts: Optional[Whole] = 1,
        part: Optional[Whole] = 0,
        run: Optional[Whole] = 0,
        reconnect: Optional[Real] = 0,
        route_check: Optional[Real] = 2,
        # end of rows
    ) -> Publisher: ...
    def watch(
        self,
        *,
        attributes: AttributeRequest = "all",
        attribute_bits: Optional[Whole] = 8,
        on_reconnect: Optional[ReconnectHandler] = None,
        # rows: watch options
        max_level: Optional[Whole] = 3,
        normal_bits: Optional[Whole] = 8,
        normals_by: Optional[Literal["server", "receiver"]] = "server",
        position_bits: Optional[Whole] = None,
        codec: Optional[Literal["entropy", "packed", "draco"]] = None,
        region: Optional[Box] = None,
        spray: Optional[bool] = False,
        bytes_per_second: Optional[Whole] = 0,
        viewpoint: Optional[Point] = None,
        reconnect: Optional[Real] = 0,
        route_check: Optional[Real] = 2,
        # end of rows
    ) -> Watcher: ...
    def watch_particles(
        self,
        *,
        on_reconnect: Optional[ReconnectHandler] = None,
        # rows: particle watch options
        max_particles: Optional[Whole] = 0,
        reconnect: Optional[Real] = 0,
        route_check: Optional[Real] = 2,
        # end of rows
    ) -> ParticleWatcher: ...
    def leave(self) -> None: ...
    def end(self) -> None: ...
    def __enter__(self) -> Session: ...
    def __exit__(self, *raised: object) -> None: ...

def session_info(fields: dict[str, Any]) -> SessionInfo: ...
