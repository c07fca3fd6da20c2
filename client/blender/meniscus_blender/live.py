"""A session of a meniscusd that is followed by a thread: it has the newest surface ready, or says why there is none."""

import threading
from dataclasses import dataclass
from typing import Any, Optional, Tuple

from .surface import surface_of
from .worker import error_text


class SessionChoice(ValueError):
    """No session, or several, are named so. The message lists those that are there."""


class AmbiguousChoice(SessionChoice):
    """Several sessions are meant: no wait for another one makes that better."""


@dataclass(frozen=True)
class Target:
    """The session to follow, and the form of its meshes."""

    session: str = ""  #: id or name; "": the only one there
    max_level: int = 3
    attributes: Tuple[str, ...] = ("all",)
    normals: bool = False


@dataclass(frozen=True)
class State:
    text: str
    is_error: bool = False


@dataclass(frozen=True)
class LiveFrame:
    key: str  #: no two frames have the same
    surface: Any
    index: int
    time: float  #: of the simulation


@dataclass(frozen=True)
class Space:
    """A session's axes and unit of length."""

    up_axis: str  #: "x", "y", "z" or "unspecified"
    length_unit: str


def chosen(sessions, wanted):
    """The one that is named, by its id or by a name that no other one has; the only one where none is named.

    Raises SessionChoice.
    """
    listed = "; there are: " + ", ".join(f"{s.name or 'no name'} ({s.id})" for s in sessions) if sessions else ""
    found = [s for s in sessions if s.id == wanted] or [s for s in sessions if not wanted or s.name == wanted]
    if len(found) == 1:
        return found[0]
    if not sessions:
        raise SessionChoice("the server has no session yet" if not wanted else f"there is no session '{wanted}' yet")
    if not found:
        raise SessionChoice(f"there is no session '{wanted}'{listed}")
    what = f"{len(found)} sessions are named '{wanted}': give the id" if wanted else "choose a session"
    raise AmbiguousChoice(what + listed)


class Follower:
    """Follows until it is stopped: also a session that comes later, or again under the same name, and a server that
    comes back.

    connect: gives a meniscus.Client, or raises. pause: seconds between attempts. final: a function of an error: whether
    another attempt makes no sense, such as after a wrong token.
    """

    def __init__(self, connect, target, pause=2.0, final=lambda error: False):
        self._connect = connect
        self._target = target
        self._pause = pause
        self._final = final
        self._changed = threading.Condition()
        self._state = State("connecting")
        self._newest: Optional[LiveFrame] = None
        self._space: Optional[Space] = None
        self._watcher = None
        self._stops = False
        self._fails = False  # with an error that no wait mends
        self._waited = False  # in vain
        self._serial = 0
        self.space_taken = False  #: whether the object has been turned and scaled as the session says
        self._thread = threading.Thread(target=self._run, name="meniscus-live", daemon=True)
        self._thread.start()

    @property
    def state(self):
        with self._changed:
            return self._state

    @property
    def newest(self):
        """The newest frame, or None."""
        with self._changed:
            return self._newest

    @property
    def space(self):
        """The session's axes and unit of length, or None before there is one."""
        with self._changed:
            return self._space

    @property
    def ended(self):
        """Whether it has given up, or was stopped."""
        return not self._thread.is_alive()

    def wait(self, seconds):
        """Until there is a frame, it has given up, or a wait makes nothing better. Gives the newest frame, or None.

        Where a wait was in vain, the next ones are none until there is a frame.
        """
        with self._changed:
            if not self._waited:
                self._changed.wait_for(lambda: self._newest is not None or self._stops or self._fails, seconds)
                self._waited = True
            return self._newest

    def wait_for_answer(self, seconds):
        """Until the server has answered, or an attempt has failed. Gives the error that no wait mends, or ""."""
        with self._changed:
            self._changed.wait_for(lambda: self._state != State("connecting") or self._stops, seconds)
            return self._state.text if self._fails else ""

    def stop(self, seconds=10.0):
        """Ends the thread; the newest frame stays."""
        with self._changed:
            self._stops = True
            watcher = self._watcher
            self._changed.notify_all()
        if watcher is not None:
            watcher.cancel()
        self._thread.join(seconds)

    def _tell(self, text, is_error=False, fails=False):
        with self._changed:
            self._state = State(text, is_error)
            self._fails = fails
            self._changed.notify_all()

    def _run(self):
        while not self._stops:
            try:
                self._follow()
            except Exception as error:
                is_final = self._final(error)
                self._tell(error_text(error), is_error=True, fails=is_final or isinstance(error, AmbiguousChoice))
                if is_final:
                    with self._changed:
                        self._stops = True
                        self._changed.notify_all()
            with self._changed:
                self._changed.wait_for(lambda: self._stops, self._pause)

    def _follow(self):
        """One connection, from its beginning to the end of the session."""
        with self._connect() as client:
            session = chosen(client.sessions(), self._target.session)
            with self._changed:
                self._space = Space(session.up_axis, session.length_unit)
            name = session.name or session.id
            self._tell(f"'{name}': no frame has come yet")
            options = {"reconnect": 30.0, "on_reconnect": self._show_attempt, "attribute_bits": 12}
            watcher = client.watch(
                session.id,
                max_level=self._target.max_level,
                normal_bits=10 if self._target.normals else 0,
                attributes=self._target.attributes if self._target.attributes != ("all",) else "all",
                **options,
            )
            with watcher:
                with self._changed:
                    self._watcher = watcher
                try:
                    while not self._stops:
                        frame = watcher.next(0.25)
                        if frame is not None:
                            self._keep(session.id, name, frame)
                        elif watcher.ended:
                            break
                finally:
                    with self._changed:
                        self._watcher = None
            if not self._stops:
                self._tell(f"'{name}' has ended; waiting for it to come again")

    def _keep(self, session_id, name, frame):
        surface = surface_of(frame.mesh, frame.statistics, self._target.normals)
        with self._changed:
            self._serial += 1
            key = f"{session_id} {frame.run_id} {frame.index} {id(self)} {self._serial}"
            self._newest = LiveFrame(key, surface, frame.index, frame.time)
            self._waited = False
        self._tell(f"'{name}': frame {frame.index}, {surface.text()}")

    def _show_attempt(self, attempt, connected, reason, seconds_left):
        if connected:
            self._tell("connected again")
        else:
            self._tell(f"connecting again (attempt {attempt}, {seconds_left:.0f} s left): {reason}", is_error=True)
