"""A recording on a server."""

from __future__ import annotations

from paraview.util.vtkAlgorithm import smhint, smproperty, smproxy

from .package import Refusal
from .properties import REFRESH, TIMES, text
from .server import CONNECTION, PATIENCE, ServerSource, chosen
from .source import rising


@smproxy.source(name="MeniscusRecording", label="Meniscus Recording", support_reload=False)
@smhint.xml('<ShowInMenu category="Meniscus"/>')
@smproperty.xml(
    CONNECTION
    + text("Session", "Session", "Its id or name; empty: whichever was recorded last.")
    + """
        <IntVectorProperty name="Number" command="SetNumber" number_of_elements="1" default_values="0">
          <Documentation>Of the session's recordings, from 1; 0: the newest.</Documentation>
        </IntVectorProperty>
        <IntVectorProperty name="Timeline" command="SetTimeline" number_of_elements="1" default_values="0">
          <EnumerationDomain name="enum">
            <Entry text="Frames" value="0"/>
            <Entry text="Simulation Time" value="1"/>
          </EnumerationDomain>
          <Documentation>
            Frames: 0, 1, 2 and so on. Simulation Time: as it was pushed, for which the whole recording is read once.
          </Documentation>
        </IntVectorProperty>"""
    + REFRESH
    + TIMES
)
class MeniscusRecording(ServerSource):
    """Frames that a server has kept. The newest recording is the first of its list."""

    def __init__(self):
        super().__init__()
        self._number, self._timeline = 0, 0
        self._recording = None
        self._simulation_times = []

    def SetNumber(self, value):
        self._set("_number", value)

    def SetTimeline(self, value):
        self._timeline = value
        self.Modified()

    def forget(self):
        self._recording, self._simulation_times = None, []
        super().forget()

    def times(self):
        before, self._recording = self._recording, self._recording_now()
        places = list(range(self._recording.frames))
        if self._timeline == 0:
            return rising(places)
        if before is None or (before.session_id, before.number) != (self._recording.session_id, self._recording.number):
            self._simulation_times = []
        known = len(self._simulation_times)
        if known < len(places):
            with self._read(known, len(places) - known) as frames:
                self._simulation_times += [frame.time for frame in frames]
        return rising(self._simulation_times, places)

    def frame_at(self, time):
        if not self._times:
            return None
        with self._read(self._place_at(time), 1) as frames:
            frame = frames.next(PATIENCE)
        if frame is None:
            raise Refusal(f"{self._address} has sent no frame in {PATIENCE:g} s")
        return frame

    def _read(self, position, count):
        return self.client().read_recording(
            self._recording.session_id, self._recording.number, position=position, count=count
        )

    def _recording_now(self):
        def name_of(recording):
            return recording.session_id, recording.name

        there = self.client().recordings()
        found = chosen(self._session, there, name_of, f"recorded session on {self._address}")
        if self._number != 0:
            numbers = {recording.number for recording in found}
            found = [recording for recording in found if recording.number == self._number]
            if not found:
                raise Refusal(f"there is no recording {self._number} of that session, but these: {sorted(numbers)}")
        return found[0]
