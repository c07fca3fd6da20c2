"""The common parts of the checks in Blender: counting, pictures, and a scene to render in."""

import os
import sys
import time

import bpy
import numpy as np

FOLDER = os.environ["MENISCUS_CHECKS"]
_counts = {True: 0, False: 0}


def check(name, holds, shown=""):
    print("ok  " if holds else "FAIL", name, "" if holds else f"({shown})", flush=True)
    _counts[bool(holds)] += 1


def end():
    """Ends Blender; the status is 1 where a check has failed."""
    print(f"{_counts[True]} passed, {_counts[False]} failed", flush=True)
    sys.stdout.flush()
    os._exit(_counts[False] != 0) if not bpy.app.background else sys.exit(_counts[False] != 0)


def wait_until(holds, seconds=60.0):
    """Gives whether it came to hold."""
    deadline = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


def install_add_on():
    """As a user does, from the archive."""
    bpy.ops.preferences.addon_install(filepath=os.path.join(FOLDER, "meniscus_blender.zip"), overwrite=True)
    bpy.ops.preferences.addon_enable(module="meniscus_blender")
    import meniscus_blender

    return meniscus_blender


def path(*names):
    return os.path.join(FOLDER, *names)


def empty_scene(width, height, samples):
    """A scene with nothing but a camera and Cycles on the CPU; the same samples in each run."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    scene = bpy.context.scene
    scene.world.use_nodes = False
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.seed = 1
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene


def render(scene, name):
    """All frames of the scene. Gives them as arrays (height, width, 4), from below."""
    scene.render.filepath = path("pictures", name + "_####")
    bpy.ops.render.render(animation=True)
    return [
        pixels(path("pictures", f"{name}_{frame:04d}.png")) for frame in range(scene.frame_start, scene.frame_end + 1)
    ]


def pixels(file):
    image = bpy.data.images.load(file)
    width, height = image.size
    read = np.array(image.pixels[:]).reshape(height, width, 4)
    bpy.data.images.remove(image)
    return read


def same(a, b):
    """Whether two renders of one scene are the same: threads of Cycles add light in their own order."""
    return a.shape == b.shape and np.abs(a - b).max() < 2.5 / 255 and np.abs(a - b).mean() < 1e-5


def check_picture(name, picture):
    """That it shows something: neither black, nor of one color, nor transparent."""
    light = picture[:, :, :3].mean(axis=2)
    check(f"{name} is neither black nor white", 0.02 < light.mean() < 0.98, light.mean())
    check(f"{name} is not of one color", light.std() > 0.02, light.std())
    edges = np.abs(np.diff(light, axis=1)).max(axis=1) > 0.02
    check(f"{name} shows a shape", edges.mean() > 0.2, edges.mean())
