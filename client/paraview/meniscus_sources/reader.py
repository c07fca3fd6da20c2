"""Files of surfaces."""

from __future__ import annotations

from paraview.util.vtkAlgorithm import smproperty, smproxy

from .package import Refusal, meniscus_package
from .properties import TIMES
from .source import Source, rising


@smproxy.reader(
    name="MeniscusSurfaces",
    label="Meniscus Surfaces",
    extensions="bricks recording",
    file_description="Meniscus surfaces",
    support_reload=False,
)
@smproperty.xml(
    """
        <StringVectorProperty name="FileNames" animateable="0" clean_command="ClearFileNames" command="AddFileName"
                              number_of_elements="0" number_of_elements_per_command="1" repeat_command="1"
                              panel_visibility="advanced">
          <FileListDomain name="files"/>
          <Documentation>One .recording, or one .bricks for each frame.</Documentation>
        </StringVectorProperty>"""
    + TIMES
)
class MeniscusSurfaces(Source):
    """Files, with the times of the simulation."""

    def __init__(self):
        super().__init__()
        self._paths = []
        self._recording = None
        self._known_times = []

    def AddFileName(self, path):
        self._paths.append(path)
        self.forget()
        self.Modified()

    def ClearFileNames(self):
        self._paths = []
        self.forget()
        self.Modified()

    def forget(self):
        self._recording, self._known_times = None, []

    def times(self):
        if not self._paths:
            raise Refusal("no file is named")
        if not self._known_times:
            self._known_times = self._read_times()
        return self._known_times

    def frame_at(self, time):
        if not self._times:
            return None
        place = self._place_at(time)
        if self._recording is not None:
            return self._recording.frame(place)
        return meniscus_package().read_bricks(self._paths[place])

    def _read_times(self):
        meniscus = meniscus_package()
        if self._paths[0].endswith(".recording"):
            if len(self._paths) > 1:
                raise Refusal(f"{len(self._paths)} recordings are named: open one at a time")
            self._recording = meniscus.RecordingFile(self._paths[0])
            return rising(self._recording.times, self._recording.indices)
        times_and_indices = [(frame.time, frame.index) for frame in map(meniscus.read_bricks, self._paths)]
        return rising([time for time, _ in times_and_indices], [index for _, index in times_and_indices])
