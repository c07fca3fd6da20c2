"""In pvpython: a session is simulated and shown, live, as a recording and as files; then its server is killed.

paraview_shows.py PASSED FAILED: numbers of earlier checks. PYTHONPATH has the package meniscus and client/paraview.
SERVER: the process of a meniscusd that listens on /files/socket and records to /files/recordings.
"""

import glob
import os
import signal
import sys
import time

import load_meniscus
import numpy as np
from paraview import simple
from paraview.servermanager import Fetch
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOImage import vtkPNGReader

from meniscus_sources.package import meniscus_package

meniscus = meniscus_package()
address = "unix:/files/socket"
radius = 0.02
passed, failed = (int(text) for text in sys.argv[1:3])


def check(name, holds):
    global passed, failed
    print("ok  " if holds else "FAIL", name, flush=True)
    passed, failed = passed + bool(holds), failed + (not holds)


def water(step):
    """Positions and velocities: a drop that falls into a pool, fewer particles with every step."""
    pool = np.mgrid[0:40, 0:40, 0:8].reshape(3, -1).T * 2 * radius
    drop = np.mgrid[0:12, 0:12, 0:12].reshape(3, -1).T * 2 * radius
    drop += (0.55, 0.55, 0.9 - 0.1 * step)
    positions = np.concatenate([pool, drop])[100 * step :]
    velocity = np.zeros_like(positions)
    velocity[-len(drop) :, 2] = -1.0 - step
    return positions, velocity


def same(name, data, mesh):
    """That ParaView has this mesh, all of it."""
    if data is None or data.GetNumberOfPoints() != len(mesh.vertices):
        return check(f"{name}: {len(mesh.vertices)} points, not {data and data.GetNumberOfPoints()}", False)
    points = data.GetPointData()
    check(name + ": places", np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), mesh.vertices))
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    check(name + ": triangles", np.array_equal(corners, mesh.triangles) and data.GetNumberOfCells() == len(corners))
    normals = points.GetNormals()
    check(name + ": normals", normals is not None and np.array_equal(vtk_to_numpy(normals), mesh.normals))
    for attribute in ("velocity", "id"):
        array = points.GetArray(attribute)
        values = mesh.attributes[attribute]
        check(f"{name}: {attribute}", array is not None and np.array_equal(vtk_to_numpy(array), values))
    levels = data.GetCellData().GetArray("level")
    check(name + ": levels", levels is not None and np.array_equal(vtk_to_numpy(levels), mesh.levels))


def shown(source, time=None):
    source.UpdatePipeline() if time is None else source.UpdatePipeline(time)
    return Fetch(source)


def field_value(data, name):
    return data.GetFieldData().GetArray(name).GetTuple1(0)


def wait_until(holds):
    """Whether it holds within 20 seconds."""
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        if holds():
            return True
        time.sleep(0.02)
    return False


def errors_of(work):
    """The errors that ParaView reports during work()."""
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        work()
    finally:
        vtkOutputWindow.SetInstance(before)
    return window.GetOutput()


def is_recorded(session_id):
    return any(info.session_id == session_id and not info.being_written for info in client.recordings())


client = meniscus.Client(address)
session = client.session(radius, name="drop", length_unit="m", attributes="all")
stream = session.stream()
pushed = []


def push(step):
    positions, velocity = water(step)
    ids = np.arange(len(positions), dtype=np.int32)
    stream.push(positions, attributes={"velocity": velocity, "id": ids}, time=1 + 0.25 * step)
    pushed.append(stream.next(60.0))


# Before its first frame a session is empty, and no error.
live = load_meniscus.MeniscusSession(Address=address, Session="drop", Reconnect=0.5)
check("a session without frames has no points", shown(live).GetNumberOfPoints() == 0)

# The package beside ParaView's own libraries.
positions, velocity = water(0)
here = meniscus.reconstruct(positions, radius, attributes={"velocity": velocity})
push(0)
check("the mesh of this process is the server's", here.sha256() == pushed[0].mesh.sha256())

source = live.GetClientSideObject()
check("a live source sees a new frame", wait_until(source.GetNeedsUpdate))
data = shown(live)
same("live", data, client.snapshot(session.id).mesh)
check("live: as many points as here", data.GetNumberOfPoints() == len(here.vertices))
check("live: time and number", (field_value(data, "time"), field_value(data, "frame")) == (1.0, 0.0))
check("a live source sees nothing new", not source.GetNeedsUpdate())

coarse = load_meniscus.MeniscusSession(Address=address, Session=session.id, MaxLevel=1)
same("coarse", shown(coarse), client.snapshot(session.id, max_level=1).mesh)
counts = shown(coarse).GetNumberOfCells(), data.GetNumberOfCells()
check("coarse: {} triangles, not {}".format(*counts), counts[0] < counts[1])

live.FramesKept = 3
for step in range(1, 5):
    push(step)
    check(f"frame {step} is seen", wait_until(source.GetNeedsUpdate))
    live.UpdatePipelineInformation()
check("the last three frames are kept", list(live.TimestepValues) == [1.5, 1.75, 2.0])
for step in (3, 2, 4):
    same(f"live at {1 + 0.25 * step}", shown(live, 1 + 0.25 * step), pushed[step].mesh)
check("between frames the one before is shown", field_value(shown(live, 1.74), "time") == 1.5)

live.FramesKept = 0
display = simple.Show(live)
simple.ColorBy(display, ("POINTS", "velocity", "Z"))
view = simple.GetActiveView()
view.ViewSize = [800, 600]
simple.ResetCamera()
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [3.5, -2.2, 2.4], [0.8, 0.8, 0.25], [0, 0, 1]
simple.ResetCamera()
simple.Render()
simple.SaveScreenshot("/files/water.png", view)
picture = vtkPNGReader()
picture.SetFileName("/files/water.png")
picture.Update()
pixels = vtk_to_numpy(picture.GetOutput().GetPointData().GetScalars()).astype(int)
background = pixels[0]
simple.Delete(view)
check("the picture shows water", 0.1 < np.mean(np.abs(pixels - background).sum(axis=1) > 30) < 0.9)

# The whole recording is there once its session is.
stream.finish()
list(stream)
session.end()
check(
    "the recording is closed",
    wait_until(lambda: not any(r.being_written for r in client.recordings() if r.name == "drop")),
)
recording = load_meniscus.MeniscusRecording(Address=address, Session="drop")
recording.UpdatePipelineInformation()
check("a recording's timeline has its frames", list(recording.TimestepValues) == [0, 1, 2, 3, 4])
for step in (2, 0, 4):
    data = shown(recording, step)
    check(f"recording at {step}: time", field_value(data, "time") == 1 + 0.25 * step)
    same(f"recording at {step}", data, pushed[step].mesh)
recording.Timeline = "Simulation Time"
recording.UpdatePipelineInformation()
check("its timeline may be the simulation's", list(recording.TimestepValues) == [1.0, 1.25, 1.5, 1.75, 2.0])
same("recording at 1.25 s", shown(recording, 1.25), pushed[1].mesh)

file = glob.glob(f"/files/recordings/{session.id}/*.recording")
opened = simple.OpenDataFile(file[0])
opened.UpdatePipelineInformation()
check("a recording's file has the simulation's times", list(opened.TimestepValues) == [1.0, 1.25, 1.5, 1.75, 2.0])
same("recording's file at 1.75", shown(opened, 1.75), pushed[3].mesh)
for step, frame in enumerate(pushed):
    frame.mesh.save(f"/files/mesh_{step}.bricks")
series = simple.OpenDataFile([f"/files/mesh_{step}.bricks" for step in range(5)])
series.UpdatePipelineInformation()
check("a series of files has a timeline", len(series.TimestepValues) == 5)
same("series at its third file", shown(series, series.TimestepValues[2]), pushed[2].mesh)

# A wrong property is an error in ParaView, in our words, and gives no surface.
for name, wrong, says in (
    ("no such session", lambda: load_meniscus.MeniscusSession(Address=address, Session="nobody"), "'nobody'"),
    ("no such recording", lambda: load_meniscus.MeniscusRecording(Address=address, Number=7), "no recording 7"),
    ("a wrong address", lambda: load_meniscus.MeniscusSession(Address="nowhere:x"), "nowhere:x"),
    ("no such file", lambda: load_meniscus.MeniscusSurfaces(FileNames=["/files/gone.bricks"]), "/files/gone.bricks"),
    ("no file of ours", lambda: load_meniscus.MeniscusSurfaces(FileNames=["/files/water.png"]), "/files/water.png"),
    (
        "no such token file",
        lambda: load_meniscus.MeniscusSession(Address=address, TokenFile="/files/gone"),
        "/files/gone",
    ),
):
    text = errors_of(lambda: shown(wrong()))
    check(f"{name} is an error: {text.splitlines()[:1]}", "Meniscus: " in text and says in text)

os.kill(int(os.environ["SERVER"]), signal.SIGKILL)
text = errors_of(lambda: shown(load_meniscus.MeniscusSession(Address=address)))
check(f"a dead server is an error: {text.splitlines()[:1]}", "Meniscus: " in text and "/files/socket" in text)
recording.InvokeCommand("Refresh")
text = errors_of(lambda: shown(recording))
check(f"so it is for a recording: {text.splitlines()[:1]}", "Meniscus: " in text)
check("a file is still shown", shown(opened, 1.0).GetNumberOfPoints() == len(here.vertices))

print(passed, "passed,", failed, "failed", flush=True)
sys.exit(failed != 0)
