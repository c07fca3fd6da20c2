# The keywords of client.py, one by one; deploy/document-rows writes those of the marked places.

import os
from typing import AsyncIterator, Literal, Optional, Sequence, Union

from .frame import Frame, ParticleFrame
from .information import RecordingInfo, ServerInfo, SessionInfo
from .opening import ReconnectHandler
from .options import AttributeRequest
from .publisher import Publisher
from .session import Session
from .stream import Stream
from .types import Box, Point, Real, Whole
from .watcher import ParticleWatcher, RecordingReader, Watcher

Path = Union[str, os.PathLike[str]]
AnySession = Union[str, SessionInfo, Session]
AnyRecording = Union[str, RecordingInfo, SessionInfo, Session]

class Client:
    address: str
    viewer: str
    def __init__(
        self,
        address: str,
        *,
        tls_ca: Optional[Path] = None,
        tls_cert: Optional[Path] = None,
        tls_key: Optional[Path] = None,
        tls_server_name: Optional[str] = None,
        token: Optional[str] = None,
        insecure: bool = False,
        timeout: Real = 10.0,
        wait: Real = 0.0,
    ) -> None: ...
    def info(self) -> ServerInfo: ...
    def serving(self) -> bool: ...
    def session(
        self,
        particle_radius: Real,
        *,
        attributes: Union[str, Sequence[str]] = "all",
        # rows: open options
        id: Optional[str] = None,
        name: Optional[str] = None,
        up_axis: Optional[Literal["unspecified", "x", "y", "z"]] = "unspecified",
        length_unit: Optional[str] = None,
        ephemeral: Optional[bool] = True,
        publish: Optional[bool] = False,
        # end of rows
        # rows: preset
        preset: Optional[Literal["smooth", "paper", "splashsurf"]] = "smooth",
        # end of rows
        # rows: settings
        cell_size: Optional[Real] = 0.5,
        iso: Optional[Real] = 0.6,
        field: Optional[Literal["color", "density", "smooth"]] = "smooth",
        smoothness: Optional[Whole] = 6,
        spray: Optional[Literal["keep", "discard", "points"]] = "keep",
        smoothing_length: Optional[Real] = 2,
        mode: Optional[Literal["adaptive", "uniform"]] = "adaptive",
        criterion: Optional[Literal["curvature", "count"]] = "curvature",
        tolerance: Optional[Real] = 0.18,
        count_threshold: Optional[Whole] = 1,
        edge_points: Optional[Literal["interpolate", "bisect"]] = "interpolate",
        bisection_steps: Optional[Whole] = 5,
        normals: Optional[bool] = True,
        domain: Optional[Box] = None,
        # end of rows
    ) -> Session: ...
    def sessions(self) -> list[SessionInfo]: ...
    def session_info(self, session: AnySession) -> SessionInfo: ...
    def delete_session(self, session: AnySession, *, unpublish: bool = False) -> None: ...
    def stream(
        self,
        session: AnySession,
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
        session: AnySession,
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
        session: AnySession,
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
        session: AnySession,
        *,
        on_reconnect: Optional[ReconnectHandler] = None,
        # rows: particle watch options
        max_particles: Optional[Whole] = 0,
        reconnect: Optional[Real] = 0,
        route_check: Optional[Real] = 2,
        # end of rows
    ) -> ParticleWatcher: ...
    def awatch(
        self,
        session: AnySession,
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
    ) -> AsyncIterator[Frame]: ...
    def awatch_particles(
        self,
        session: AnySession,
        *,
        on_reconnect: Optional[ReconnectHandler] = None,
        # rows: particle watch options
        max_particles: Optional[Whole] = 0,
        reconnect: Optional[Real] = 0,
        route_check: Optional[Real] = 2,
        # end of rows
    ) -> AsyncIterator[ParticleFrame]: ...
    def snapshot(
        self,
        session: AnySession,
        *,
        attributes: AttributeRequest = "all",
        attribute_bits: Optional[Whole] = 8,
        # rows: snapshot options
        max_level: Optional[Whole] = 3,
        normal_bits: Optional[Whole] = 8,
        normals_by: Optional[Literal["server", "receiver"]] = "server",
        position_bits: Optional[Whole] = None,
        codec: Optional[Literal["entropy", "packed", "draco"]] = None,
        # end of rows
    ) -> Optional[Frame]: ...
    def recordings(self) -> list[RecordingInfo]: ...
    def read_recording(
        self,
        session: AnyRecording,
        number: Optional[Whole] = None,
        *,
        position: Whole = 0,
        count: Whole = 0,
        spray: bool = False,
        normals_by: Literal["server", "receiver"] = "server",
    ) -> RecordingReader: ...
    def delete_recording(self, session: AnyRecording, number: Optional[Whole] = None) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> Client: ...
    def __exit__(self, *_: object) -> None: ...
