"""A connection to one server."""

from __future__ import annotations

import os
from functools import partial
from typing import Any, AsyncIterator, Optional, Sequence, Union

from . import _meniscus
from .background import in_background
from .errors import InvalidInput
from .frame import Frame, ParticleFrame
from .information import RecordingInfo, ServerInfo, SessionInfo
from .opening import open_particle_watcher, open_publisher, open_stream, open_watcher
from .options import AttributeRequest, attribute_text, names_text, option_texts
from .publisher import Publisher
from .session import Session, session_info
from .stream import Stream
from .types import Real, Whole
from .watcher import ParticleWatcher, RecordingReader, Watcher

Path = Union[str, "os.PathLike[str]"]
#: A session by its name, its id, or an object that stands for it.
AnySession = Union[str, SessionInfo, Session]
AnyRecording = Union[str, RecordingInfo, SessionInfo, Session]


class Client:
    """A connection to a meniscusd. Several threads may use it at once; what it opens lives on without it.

    address: "HOST:PORT", "HOST" for port 50051, or "unix:PATH"; IPv6 stands in brackets. TLS wants ``tls_ca`` (PEM
    file), mutual TLS ``tls_cert`` and ``tls_key``, too; ``tls_server_name`` is the name in the server's certificate,
    by default the host. ``token`` is sent with every call, to other machines only by TLS or with ``insecure=True``.
    ``timeout``: seconds for which a host may not answer. ``wait``: seconds for a server that is still starting.

    Raises ServerError (unavailable) if the server is not there, InvalidInput for a wrong address or option. Ctrl-C ends
    whatever waits.
    """

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
    ) -> None:
        self.address = address
        self.viewer = ""  #: the page of the server's viewer; "": not known
        options = {
            "tls_ca": tls_ca,
            "tls_cert": tls_cert,
            "tls_key": tls_key,
            "tls_server_name": tls_server_name,
            "token": token,
            "insecure": insecure,
            "timeout": timeout,
            "wait": wait,
        }
        self._raw = _meniscus.connect(address, option_texts(options))

    def info(self) -> ServerInfo:
        """The server's version, backend and limits."""
        return ServerInfo(**self._raw.info())

    def serving(self) -> bool:
        """Whether the server takes calls: False once it shuts down."""
        return self._raw.serving()

    def session(
        self, particle_radius: Real, *, attributes: Union[str, Sequence[str]] = "all", **options: Any
    ) -> Session:
        """Opens a session that ends with the object returned, unless it was there before.

        The keywords are the settings, as Reconstructor has them, and those of the session: ``name`` (what people call
        it), ``id`` (a UUID: joins the session if it is there with equal settings; None: a new one), ``up_axis`` ("x",
        "y" or "z"), ``length_unit`` (such as "m"), ``ephemeral`` (True: the server ends the session some seconds after
        its stream, so that a process that is killed leaves nothing behind; False: it may rest),
        ``publish`` (True: the server publishes it as plain files, under ``/publications/ID/`` of its HTTP port).
        """
        texts = option_texts({"particle_radius": particle_radius, **options})
        if "id" in texts:
            texts["session"] = texts.pop("id")
        texts["attribute"] = names_text(attributes)
        return Session(self._raw.open_session(texts), self.viewer)

    def sessions(self) -> list[SessionInfo]:
        """The server's sessions that this client may see."""
        return [session_info(fields) for fields in self._raw.sessions()]

    def session_info(self, session: AnySession) -> SessionInfo:
        """A session by its name or id. Raises InvalidInput where no session has the name, or several have it, with
        those that there are; ServerError (not_found) for an id that none has. So do the calls below."""
        return session_info(self._raw.session_info(_id_text(session)))

    def delete_session(self, session: AnySession, *, unpublish: bool = False) -> None:
        """Ends a session, also one that another client made.

        unpublish: what it has published goes with it, at once, also of an id whose session has ended before; otherwise
        readers have that for some time more.
        """
        self._raw.delete_session(_id_text(session), unpublish)

    def stream(self, session: AnySession, **options: Any) -> Stream:
        """Opens the stream of a session that is there.

        meshes          True: they come back; False: their figures alone
        normal_bits     8: 2 to 16, 0 for none
        normals_by      "server"; "receiver": computed here from the triangles, also where the session has none: none
                        are sent, which saves half of the bytes or more, and normal_bits does not count
        codec           None: "packed", the fastest, from a server on this machine, "entropy", the smallest, from
                        others; or "draco"
        attributes      "all", names, or names with bits as in {"velocity": 12, "age": 0}: those that the meshes have
        attribute_bits  8: float32 are rounded to one of 2^bits values over the frame's range, 1 to 16; 0: exact
        spray           False: whether the particles that the surface leaves out come beside it
        waiting_limit   0: received frames that wait at most, beyond which push() waits; 0: no limit
        policy          "every-frame": push() waits; "latest": the newest one replaces the one that waits;
                        "every-nth": the first of every ``nth`` is reconstructed
        parts           1: streams, of other processes too, that each push a part of every frame, with the same indices
                        and times; whatever ends one of them ends all
        part            0: the number of this one, counted from 0; meshes come to part 0 alone
        run             0: with ``parts``, a number that all of them share, and no other run: let one process draw it
        reconnect       0: seconds for which the server may be out of reach; nothing is lost meanwhile
        route_check     2: seconds between looks for the session's server behind a proxy, with ``reconnect``
        on_reconnect    called at each attempt (attempt, connected, reason, seconds left), until close()
        """
        return open_stream(partial(self._raw.stream, _id_text(session)), **options)

    def publish(self, session: AnySession, **options: Any) -> Publisher:
        """Opens a publisher to a session that is there, and has had no particles.

        codec           "packed", the fastest; or "entropy", the smallest. Receivers that ask for it and for the same
                        bits are sent the bricks as they are
        normal_bits     8: 2 to 16; where the session's settings ask for no normals, there are none
        attribute_bits  8: float32 are rounded to one of 2^bits values over the mesh's range, 1 to 16; 0: exact
        parts           1: publishers, of other processes too, that each have some of the bricks of every frame; no
                        brick has two owners
        waiting_limit, policy, nth, part, run, reconnect, route_check, on_reconnect  as those of stream()
        """
        return open_publisher(partial(self._raw.publish, _id_text(session)), **options)

    def watch(self, session: AnySession, **options: Any) -> Watcher:
        """Receives the meshes of somebody's session, always the newest.

        max_level         3: finest level of grid, 1 to 3; below 3 the surface is coarser, and as closed
        normal_bits       8: 2 to 16, 0 for none
        normals_by        as that of stream()
        position_bits     None: as reconstructed; else vertices lie on multiples of cell_size / 2^position_bits
        codec             as that of stream()
        attributes        as those of stream(), with attribute_bits
        region            None; or ((x0, y0, z0), (x1, y1, z1)): only bricks that touch it
        spray             False: whether the particles that the surface leaves out come beside it
        bytes_per_second  0: no limit; else frames are skipped to keep it
        viewpoint         None; or (x, y, z): nearest bricks are sent first
        reconnect, route_check, on_reconnect  as those of stream()
        """
        return open_watcher(partial(self._raw.watch, _id_text(session)), **options)

    def watch_particles(self, session: AnySession, **options: Any) -> ParticleWatcher:
        """Receives the particles of somebody's session, always the newest. ``max_particles`` (0: all): of a frame with
        more, only every k-th is sent. ``reconnect``, ``route_check``, ``on_reconnect`` as those of stream()."""
        return open_particle_watcher(partial(self._raw.watch_particles, _id_text(session)), **options)

    async def awatch(self, session: AnySession, **options: Any) -> AsyncIterator[Frame]:
        """``async for frame in client.awatch(session_id, max_level=2)``: as watch()."""
        with await in_background(partial(self.watch, session, **options)) as watcher:
            async for frame in watcher:
                yield frame

    async def awatch_particles(self, session: AnySession, **options: Any) -> AsyncIterator[ParticleFrame]:
        """Watches as watch_particles() does, for asyncio."""
        with await in_background(partial(self.watch_particles, session, **options)) as watcher:
            async for frame in watcher:
                yield frame

    def snapshot(self, session: AnySession, *, attributes: AttributeRequest = "all", **options: Any) -> Optional[Frame]:
        """The session's newest mesh; None if no frame has come yet. Keywords: ``max_level``, ``normal_bits``,
        ``normals_by``, ``position_bits``, ``codec``, ``attributes`` and ``attribute_bits``, as those of watch()."""
        texts = option_texts(options)
        texts["attribute"] = attribute_text(attributes)
        raw = self._raw.snapshot(_id_text(session), texts)
        return None if raw is None else Frame(raw)

    def recordings(self) -> list[RecordingInfo]:
        """The server's recordings, the newest first. Raises ServerError (unimplemented) if it records nothing."""
        return [RecordingInfo(**fields) for fields in self._raw.recordings()]

    def read_recording(
        self,
        session: AnyRecording,
        number: Optional[Whole] = None,
        *,
        position: Whole = 0,
        count: Whole = 0,
        spray: bool = False,
        normals_by: str = "server",
    ) -> RecordingReader:
        """Reads frames of a recording in order: ``count`` at most (0: all) from the place ``position`` on.
        ``normals_by``: "server", as recorded, or "receiver", as those of stream(), which saves no bytes here.

        session: a RecordingInfo, which has its number; or the name or the id of a session, with the ``number``.
        """
        found = _recording(session, number)
        return RecordingReader(self._raw.read_recording(*found, position, count, spray, normals_by))

    def delete_recording(self, session: AnyRecording, number: Optional[Whole] = None) -> None:
        """Deletes the recording's file. Raises ServerError (failed_precondition) while it is written or read."""
        self._raw.delete_recording(*_recording(session, number))

    def close(self) -> None:
        """Ends the connection; the end of a ``with`` block calls it. What was opened lives on."""
        self._raw.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<meniscus.Client {self.address}>"


def _id_text(session: Any) -> str:
    """What C++ looks up, which refuses all but texts."""
    text: str = session.id if isinstance(session, (SessionInfo, Session)) else session
    return text


def _recording(session: Any, number: Any) -> tuple[str, int]:
    if isinstance(session, RecordingInfo):
        return session.session_id, session.number if number is None else number
    if number is None:
        raise InvalidInput("number is None, must be that of the recording, from 1: or give a RecordingInfo alone")
    return _id_text(session), number
