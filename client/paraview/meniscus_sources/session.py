"""A live session."""

from __future__ import annotations

from collections import deque

from paraview.util.vtkAlgorithm import smhint, smproperty, smproxy

from .package import Refusal, meniscus_package
from .properties import REFRESH, TIMES, text
from .server import CONNECTION, PATIENCE, ServerSource, chosen, listed
from .source import rising


@smproxy.source(name="MeniscusSession", label="Meniscus Session", support_reload=False)
@smhint.xml('<ShowInMenu category="Meniscus"/>')
@smhint.xml('<LiveSource interval="100"/>')
@smproperty.xml(
    CONNECTION
    + text("Session", "Session", "Its id or name; may be empty where the server has one session.")
    + """
        <IntVectorProperty name="MaxLevel" label="Max Level" command="SetMaxLevel" number_of_elements="1"
                           default_values="3">
          <IntRangeDomain name="range" min="1" max="3"/>
          <Documentation>Finest level of grid. Below 3 the surface is coarser, and as closed.</Documentation>
        </IntVectorProperty>
        <IntVectorProperty name="FramesKept" label="Frames Kept" command="SetFramesKept" number_of_elements="1"
                           default_values="0">
          <IntRangeDomain name="range" min="0" max="100000"/>
          <Documentation>
            0: the newest frame is shown, whatever the time. Otherwise the last so many frames of this run make a
            timeline, encoded in memory, and the time chooses among them.
          </Documentation>
        </IntVectorProperty>
        <DoubleVectorProperty name="Reconnect" command="SetReconnect" number_of_elements="1" default_values="30"
                              panel_visibility="advanced">
          <DoubleRangeDomain name="range" min="0"/>
          <Documentation>Seconds for which the server may be out of reach before that is an error.</Documentation>
        </DoubleVectorProperty>"""
    + REFRESH
    + TIMES
)
class MeniscusSession(ServerSource):
    """A session that goes on."""

    def __init__(self):
        super().__init__()
        self._max_level, self._frames_kept, self._reconnect = 3, 0, 30.0
        self._watcher, self._watched = None, ""
        self._frames = deque(maxlen=1)

    def SetMaxLevel(self, value):
        self._set("_max_level", value)

    def SetFramesKept(self, value):
        self._frames_kept = value
        self._frames = deque(self._frames, maxlen=max(value, 1))
        self.Modified()

    def SetReconnect(self, value):
        self._set("_reconnect", value)

    def GetNeedsUpdate(self):
        """ParaView asks ten times a second, and shows what is new."""
        if self._watcher is None:
            return False
        try:
            news = self._take_ready()
        except meniscus_package().Error:
            self._stop_watching()  # the update that follows begins anew, and shows an error if that fails
            news = True
        if news:
            self.Modified()
        return news

    def Refresh(self):
        if self._watcher is not None and self._watcher.ended:
            self._stop_watching()
        super().Refresh()

    def forget(self):
        self._stop_watching()
        self._frames.clear()
        super().forget()

    def times(self):
        try:
            self._watch()
        except meniscus_package().Error:
            self._stop_watching()  # a later look begins anew
            raise
        if self._frames_kept == 0:
            return []
        return rising([frame.time for frame in self._frames], [frame.index for frame in self._frames])

    def frame_at(self, time):
        if not self._frames:
            return None
        return self._frames[self._place_at(time) if self._times else -1]

    def _watch(self):
        if self._watcher is None:
            session = self._session_now()
            self._watcher = self.client().watch(session.id, max_level=self._max_level, reconnect=self._reconnect)
            if session.id != self._watched:
                self._watched = session.id
                self._frames.clear()
            if session.last_frame_index is not None:
                self._take(self._watcher.next(PATIENCE))
        self._take_ready()

    def _take_ready(self):
        """Whether there were frames that are new."""
        count = 0
        for frame in self._watcher.ready():
            self._take(frame)
            count += 1
        return count > 0

    def _take(self, frame):
        if frame is None:
            return
        if self._frames and frame.index <= self._frames[-1].index:
            self._frames.clear()  # the simulation began anew
        self._frames.append(frame)

    def _stop_watching(self):
        if self._watcher is not None:
            self._watcher.close()
        self._watcher = None

    def _session_now(self):
        def name_of(session):
            return session.id, session.name

        found = chosen(self._session, self.client().sessions(), name_of, f"session on {self._address}")
        if len(found) > 1:
            raise Refusal(f"which session? There are {listed(found, name_of)}: name one, by its id if need be")
        return found[0]
