"""Blocks of particles of known velocity, their number another at each frame: the width of the blur is measured."""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.environ["MENISCUS_CHECKS"])
from checks import check, empty_scene, end, install_add_on, path, render  # noqa: E402

SPEED = 6.0  # units a second, along x
FPS, SHUTTER, PIXELS_PER_UNIT = 24, 0.5, 50

install_add_on()
side = (np.arange(10) + 0.5) / 10 - 0.5
block = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3)
for number, heights in ((10, (0.0,)), (20, (-1.0, 1.0)), (30, (-1.5, 0.0, 1.5))):
    positions = np.concatenate([block * [1, 1, 1] + [0, height, 0] for height in heights]).astype(np.float32)
    velocity = np.tile(np.float32([SPEED, 0, 0]), (len(positions), 1))
    np.savez(path(f"blocks_{number:03d}.npz"), positions=positions, velocity=velocity)

scene = empty_scene(200, 200, 64)
bpy.ops.meniscus.import_sequence(filepath=path("blocks_010.npz"), particle_radius=0.05)
obj, mesh = bpy.context.object, bpy.context.object.data
settings = obj.meniscus.sequence
check(
    "the files are found with their stride",
    (settings.first, settings.last, settings.stride) == (10, 30, 10),
    (settings.first, settings.last, settings.stride),
)
check("the scene ends with the sequence", scene.frame_end == 3, scene.frame_end)

material = bpy.data.materials.new("white")
material.use_nodes = True
nodes = material.node_tree.nodes
nodes.clear()
emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
material.node_tree.links.new(emission.outputs[0], output.inputs[0])
mesh.materials.append(material)
scene.world.color = (0, 0, 0)
scene.view_settings.view_transform = "Raw"
scene.camera.location = (0, 0, 10)
scene.camera.data.type = "ORTHO"
scene.camera.data.ortho_scale = 200 / PIXELS_PER_UNIT
scene.render.fps = FPS
scene.render.motion_blur_shutter = SHUTTER

counts = []
for frame in (1, 2, 3):
    scene.frame_set(frame)
    counts.append(len(mesh.polygons))
    velocity = np.empty(3 * len(mesh.vertices), np.float32)
    attribute = mesh.attributes["velocity"]
    attribute.data.foreach_get("vector", velocity)
    check(
        f"frame {frame}: velocity is a vector of each point",
        (attribute.domain, attribute.data_type) == ("POINT", "FLOAT_VECTOR")
        and np.allclose(velocity.reshape(-1, 3), [SPEED, 0, 0], atol=1e-3),
    )
check("the triangles are others at each frame", len(set(counts)) == 3 and min(counts) > 100, counts)
check("the mesh stays, with its material", obj.data == mesh and mesh.materials[0] == material)


def blur_width(picture):
    """Pixels from the last black one to the first white one, in the row with most light, on the left."""
    light = picture[:, :, 0]
    row = light[light.sum(axis=1).argmax()]
    return int(np.argmax(row > 0.98)) - int(np.argmax(row > 0.02))


def rows_with_light(picture):
    lit = picture[:, :, 0].max(axis=1) > 0.5
    return int(np.count_nonzero(np.diff(lit.astype(int)) == 1)) + int(lit[0])


wanted = SPEED / FPS * SHUTTER * PIXELS_PER_UNIT
scene.render.use_motion_blur = True
for frame, picture in enumerate(render(scene, "blurred"), 1):
    width = blur_width(picture)
    check(f"frame {frame}: {wanted:.2f} pixels of blur", abs(width - wanted) <= 2.5, width)
    check(f"frame {frame}: {frame} blocks", rows_with_light(picture) == frame, rows_with_light(picture))
obj.meniscus.velocity_scale = 3.0
for frame, picture in enumerate(render(scene, "blurred_more"), 1):
    width = blur_width(picture)
    check(f"frame {frame}: three times as much by the velocity's scale", abs(width - 3 * wanted) <= 4, width)
obj.meniscus.velocity_scale = 1.0
scene.render.use_motion_blur = False
for frame, picture in enumerate(render(scene, "sharp"), 1):
    check(f"frame {frame}: none without motion blur", blur_width(picture) <= 3, blur_width(picture))
end()
