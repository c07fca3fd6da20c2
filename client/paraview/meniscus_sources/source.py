"""What the sources have in common: a timeline, and errors that are ParaView's."""

from __future__ import annotations

from bisect import bisect_right

from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline

from .package import Refusal, meniscus_package
from .surface import fill


class Source(VTKPythonAlgorithmBase):
    """A source whose errors are ParaView's: one line, and no data."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self._times = []

    def times(self):
        """Of the timeline, rising; empty: there is none. Known before data are asked for."""
        raise NotImplementedError

    def frame_at(self, time):
        """The frame that is shown at the time, or None."""
        raise NotImplementedError

    def RequestInformation(self, _request, _inputs, outputs):
        return self._try(lambda: self._announce(outputs.GetInformationObject(0)))

    def RequestData(self, _request, _inputs, outputs):
        output = vtkPolyData.GetData(outputs)
        output.Initialize()
        return self._try(lambda: self._show(outputs.GetInformationObject(0), output))

    def Refresh(self):
        """Looks again at what there is."""
        self.Modified()

    def _announce(self, info):
        self._times = self.times()
        info.Remove(pipeline.TIME_STEPS())
        info.Remove(pipeline.TIME_RANGE())
        for time in self._times:
            info.Append(pipeline.TIME_STEPS(), time)
        if self._times:
            info.Set(pipeline.TIME_RANGE(), [self._times[0], self._times[-1]], 2)

    def _show(self, info, output):
        time = info.Get(pipeline.UPDATE_TIME_STEP()) if info.Has(pipeline.UPDATE_TIME_STEP()) else 0.0
        frame = self.frame_at(time)
        if frame is not None:
            fill(output, frame)
        if self._times:
            output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), self._times[self._place_at(time)])

    def _place_at(self, time):
        return max(bisect_right(self._times, time) - 1, 0)

    def _try(self, work):
        try:
            meniscus = meniscus_package()
            try:
                work()
                return 1
            except meniscus.Error as error:
                raise Refusal(str(error)) from error
        except Refusal as refusal:
            vtkOutputWindow.GetInstance().DisplayErrorText(f"Meniscus: {refusal}\n")
            return 0

    def _set(self, name, value):
        """A property of the user's; what was done with the value before is forgotten. ParaView passes "" as None."""
        value = "" if value is None else value
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.forget()
            self.Modified()

    def forget(self):
        """Lets go of what the properties have led to."""


def rising(*candidates):
    """The first of the lists of times that rises from frame to frame, as timelines must."""
    for times in candidates:
        if all(a < b for a, b in zip(times, times[1:])):
            return [float(time) for time in times]
    return [float(place) for place in range(len(candidates[0]))]
