"""In ParaView's window: a live session is shown, and its new frames without anybody's doing. For paraview --script.

Ends the process once enough frames were drawn, whose numbers are in /files/drawn.
"""

import os

import load_meniscus
from paraview import simple

live = load_meniscus.MeniscusSession(Address="unix:/files/socket", Session="window")
simple.Show(live)
view = simple.GetActiveView()
drawn = []


def note(*_):
    array = live.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetArray("frame")
    if array is not None and array.GetTuple1(0) not in drawn:
        drawn.append(array.GetTuple1(0))
    if len(drawn) >= 5:
        with open("/files/drawn", "w") as file:
            file.write(" ".join(f"{frame:.0f}" for frame in drawn))
        os._exit(0)


view.SMProxy.GetRenderWindow().AddObserver("EndEvent", note)
simple.Render()
