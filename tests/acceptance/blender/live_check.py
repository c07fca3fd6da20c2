"""A live session of a real server: followed, rendered, ended; a server that dies."""

import os
import signal
import sys
import time

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.environ["MENISCUS_CHECKS"])
from checks import check, check_picture, empty_scene, end, install_add_on, path, pixels, wait_until  # noqa: E402

import meniscus  # noqa: E402

install_add_on()
from meniscus_blender import live_objects, status  # noqa: E402

ADDRESS = "unix:" + path("socket")
scene = empty_scene(320, 240, 16)
scene.camera.location = (3, -3, 3)
scene.camera.rotation_euler = (-scene.camera.location).to_track_quat("-Z", "Y").to_euler()
sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.rotation_euler = (0.5, 0.3, 0)
scene.collection.objects.link(sun)
scene.render.use_motion_blur = True

bpy.ops.meniscus.add_live()
obj, mesh = bpy.context.object, bpy.context.object.data
obj.meniscus.live.address = ADDRESS
obj.meniscus.live.session = "wave"
side = (np.arange(14) + 0.5) * 0.1 - 0.7
block = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3)


def frame_positions(number):
    """A block that breaks into two and loses particles, in centimeters, y up."""
    parts = block + np.where(block[:, :1] > 0, [0.3 * number, 0.2 * number, 0], [0, 0, 0])
    return parts[196 * number :] * 100


def state_has(part, is_error):
    def holds():
        live_objects.update(obj)
        shown = status.of(obj.name)
        return part in shown.text and (shown.kind == "ERROR") == is_error

    return holds


bpy.ops.meniscus.connect()
check(
    "a session that is not there yet is reported",
    wait_until(state_has("no session 'wave' yet", True)),
    status.of(obj.name),
)

client = meniscus.Client(ADDRESS)
session = client.session(5.0, name="wave", up_axis="y", length_unit="cm", ephemeral=False)
stream = session.stream(meshes=False)


def push(number):
    positions = frame_positions(number)
    velocity = np.tile(np.float32([300, 0, 0]), (len(positions), 1))
    stream.push(positions, attributes={"velocity": velocity}, time=number / 24)
    follower = live_objects.follower_of(obj)
    return wait_until(lambda: follower.newest is not None and follower.newest.index == number)


counts, pictures = [], []
for number in range(3):
    check(f"frame {number} arrives", push(number), status.of(obj.name))
    scene.render.filepath = path("pictures", f"live_{number}")
    scene.frame_set(number + 1)
    bpy.ops.render.render(write_still=True)
    counts.append(len(mesh.polygons))
    pictures.append(pixels(path("pictures", f"live_{number}.png")))
    check_picture(f"live frame {number}", pictures[-1])
check("the mesh is another at each frame", len(set(counts)) == 3 and min(counts) > 100, counts)
check("so is the picture", all(np.abs(a - b).mean() > 1e-3 for a, b in zip(pictures, pictures[1:])))
check("the status names the frame", "'wave': frame 2, " in status.of(obj.name).text, status.of(obj.name))
attribute = mesh.attributes["velocity"]
values = np.empty(3 * len(mesh.vertices), np.float32)
attribute.data.foreach_get("vector", values)
check(
    "velocity is a vector of each point",
    attribute.domain == "POINT" and np.allclose(values.reshape(-1, 3), [300, 0, 0], atol=0.2),
)
check("centimeters become meters", np.allclose(obj.scale, 0.01), tuple(obj.scale))
check("y points upward", (obj.matrix_world.to_3x3() @ Vector((0, 1, 0))).z > 0.0099)
surface = client.snapshot(session.id).mesh
check("the mesh is the server's", len(surface.triangles) == len(mesh.polygons))
check(
    "to the vertex",
    np.allclose(np.array([v.co for v in mesh.vertices[:50]]), surface.vertices[:50].astype(np.float32), atol=0),
)

other = client.session(5.0, name="other", ephemeral=False)
obj.meniscus.live.session = ""
try:
    bpy.ops.meniscus.connect()
    reported = ""
except RuntimeError as error:
    reported = str(error)
check("several sessions of which none is chosen are listed", "choose a session; there are: " in reported, reported)
begin = time.monotonic()
scene.frame_set(8)
check("and no frame waits for one", time.monotonic() - begin < 10)
other.end()
obj.meniscus.live.session = "wave"
bpy.ops.meniscus.connect()
check("the chosen one is followed", wait_until(lambda: live_objects.follower_of(obj).newest is not None))

bpy.ops.meniscus.list_sessions()
listed = [entry.name for entry in bpy.context.window_manager.meniscus_sessions]
check("the sessions are listed", listed == ["wave"], listed)

before = live_objects.follower_of(obj).newest.key
stream.finish()
stream.close()
session.end()
check(
    "the end of the session is reported",
    wait_until(state_has("has ended", False)) or wait_until(state_has("no session", True)),
)
check("the last surface stays", len(mesh.polygons) == counts[-1])
session = client.session(5.0, name="wave", ephemeral=False)
stream = session.stream(meshes=False)
stream.push(frame_positions(0))
follower = live_objects.follower_of(obj)
check("a new session of the name is followed", wait_until(lambda: follower.newest.key != before))

os.kill(int(os.environ["MENISCUSD_PID"]), signal.SIGKILL)
check("a server that died is an error", wait_until(state_has("", True)), status.of(obj.name))
check("which names what is wrong", len(status.of(obj.name).text) > 10, status.of(obj.name))
bpy.ops.meniscus.disconnect()
check("disconnecting keeps the surface", len(mesh.polygons) > 100 and live_objects.follower_of(obj) is None)

bpy.ops.meniscus.connect()
check("a server that is not there is an error", wait_until(state_has("socket", True)), status.of(obj.name))
bpy.ops.meniscus.disconnect()
obj.meniscus.live.address = "no address:at:all"
try:
    bpy.ops.meniscus.connect()
    reported = ""
except RuntimeError as error:
    reported = str(error)
check("a wrong address is refused", "no address" in reported, reported)
check("so that no frame waits for it", live_objects.follower_of(obj) is None)
obj.meniscus.live.token_file = path("nothing")
try:
    bpy.ops.meniscus.connect()
    reported = ""
except RuntimeError as error:
    reported = str(error)
check("a token's file that is not there is named", path("nothing") in reported, reported)
obj.meniscus.live.token_file = ""
obj.meniscus.live.token = "secret-of-mine"
bpy.ops.wm.save_as_mainfile(filepath=path("live.blend"), compress=False)
with open(path("live.blend"), "rb") as saved:
    check("the token is not saved with the file", b"secret-of-mine" not in saved.read())
print("status with the server dead:", status.of(obj.name))
end()
