"""A sequence of real frames: rendered as water, cached, missing, wrong; saved for `blender -b -a`."""

import os
import sys

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.environ["MENISCUS_CHECKS"])
from checks import check, check_picture, empty_scene, end, install_add_on, path, render, same  # noqa: E402

install_add_on()
from meniscus_blender import preferences, services, status  # noqa: E402

bpy.context.preferences.addons["meniscus_blender"].preferences.cache_folder = path("cache")
check("the cache is where it was set", services.reconstruction.cache.folder == path("cache"))


def water():
    """Blue glass over what the velocity makes white."""
    material = bpy.data.materials.new("Water")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.15
    attribute, length, ramp = (
        nodes.new(kind) for kind in ("ShaderNodeAttribute", "ShaderNodeVectorMath", "ShaderNodeValToRGB")
    )
    attribute.attribute_name = "velocity"
    length.operation = "LENGTH"
    ramp.color_ramp.elements[0].color = (0.02, 0.12, 0.35, 1)
    ramp.color_ramp.elements[1].color = (0.9, 0.95, 1, 1)
    divide = nodes.new("ShaderNodeMath")
    divide.operation = "DIVIDE"
    divide.inputs[1].default_value = 6.0
    links.new(attribute.outputs["Vector"], length.inputs[0])
    links.new(length.outputs["Value"], divide.inputs[0])
    links.new(divide.outputs[0], ramp.inputs[0])
    links.new(ramp.outputs["Color"], shader.inputs["Base Color"])
    return material


scene = empty_scene(480, 360, 24)
bpy.ops.meniscus.import_sequence(filepath=path("frames", "frame_040.vtk"), particle_radius=0.025, up_axis="y")
obj, mesh = bpy.context.object, bpy.context.object.data
mesh.materials.append(water())
scene.camera.location = (5.5, -5.5, 4.0)
scene.camera.rotation_euler = (Vector((0, 0, 1.0)) - scene.camera.location).to_track_quat("-Z", "Y").to_euler()
sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.data.energy = 3
sun.rotation_euler = (0.7, 0.2, 0.5)
scene.collection.objects.link(sun)
scene.world.color = (0.25, 0.3, 0.35)
scene.render.use_motion_blur = True

seen = {}
bpy.app.handlers.render_post.append(lambda *_: seen.__setitem__(scene.frame_current, len(mesh.polygons)))
pictures = render(scene, "water")
for frame, picture in enumerate(pictures, 1):
    check_picture(f"water, frame {frame}", picture)
check("frames differ", all(np.abs(a - b).mean() > 1e-3 for a, b in zip(pictures, pictures[1:])))

viewport = {}
for frame in (1, 2, 3):
    scene.frame_set(frame)
    viewport[frame] = len(mesh.polygons)
check(
    "renders have the finer settings, the viewport the coarser ones",
    all(seen[frame] > 2 * viewport[frame] > 1000 for frame in (1, 2, 3)),
    (seen, viewport),
)
check("the status has the counts", "11,492 particles" in status.of(obj.name).text, status.of(obj.name))
check("the radius fits, so nothing warns", status.of(obj.name).kind == "INFO")
rotated = obj.matrix_world @ Vector((0, 1, 0))
check("y of the file points upward", rotated.z > 0.99, rotated)
check("the surface is shaded smooth", mesh.polygons[0].use_smooth)
check("the mesh is valid", not mesh.validate())

kept = {entry.name: entry.inode() for entry in os.scandir(path("cache"))}
check("the cache has a surface for each frame and quality", len(kept) == 6, sorted(kept))
made = []
reconstruct = services.reconstruction._reconstruct
services.reconstruction._reconstruct = lambda *given: made.append(given) or reconstruct(*given)
again = render(scene, "water")
check("what was rendered once comes from the cache", made == [] and all(map(same, again, pictures)))

obj.meniscus.sequence.render.cell_size = 0.7
check("filling the cache ends well", bpy.ops.meniscus.fill_cache(quality="render") == {"FINISHED"})
filling = services.worker.filling(obj.name)
check("it makes every frame", (filling.done, filling.total, len(made)) == (3, 3, 3), (filling, len(made)))
obj.meniscus.sequence.render.cell_size = 0.5

obj.meniscus.normals = True
scene.frame_set(2)
mesh.calc_normals_split()
loops = np.empty(3 * len(mesh.loops), np.float32)
mesh.loops.foreach_get("normal", loops)
check(
    "the field's normals are those of the corners",
    mesh.has_custom_normals and abs(np.linalg.norm(loops[:3]) - 1) < 1e-3,
)
obj.meniscus.normals = False

bpy.ops.wm.save_as_mainfile(filepath=path("water.blend"))

os.rename(path("frames", "frame_041.vtk"), path("frames", "away"))
scene.frame_set(2)
shown = status.of(obj.name)
check(
    "a missing file is named",
    shown.kind == "ERROR" and "frame_{}.vtk: there is no file with the number 41" in shown.text,
    shown,
)
check("and nothing old is shown in its place", len(mesh.polygons) == 0)
scene.frame_set(3)
check("the next frame is there", len(mesh.polygons) == viewport[3] and status.of(obj.name).kind == "INFO")
os.rename(path("frames", "away"), path("frames", "frame_041.vtk"))

os.rename(path("frames", "frame_042.vtk"), path("away"))
with open(path("away"), "rb") as whole, open(path("frames", "frame_042.vtk"), "wb") as cut:
    cut.write(whole.read(1000))
scene.frame_set(3)
check("a damaged file is an error", status.of(obj.name).kind == "ERROR" and "frame_042" in status.of(obj.name).text)
os.replace(path("away"), path("frames", "frame_042.vtk"))

obj.meniscus.sequence.particle_radius = 0.005
scene.frame_set(1)
shown = status.of(obj.name)
check("a radius that does not fit is a warning", shown.kind == "WARNING" and 0.015 < shown.fitting_radius < 0.04, shown)
bpy.ops.meniscus.use_fitting_radius(radius=shown.fitting_radius)
scene.frame_set(1)
check("which is mended by a button", status.of(obj.name).kind == "INFO", status.of(obj.name))
obj.meniscus.sequence.particle_radius = 0.025
obj.meniscus.sequence.attributes = "velocity age"
scene.frame_set(1)
check("an attribute that is not there is named", "no attribute 'age'; there are:" in status.of(obj.name).text)
obj.meniscus.sequence.attributes = "id"
scene.frame_set(1)
check("ids are whole numbers", mesh.attributes["id"].data_type == "INT" and "velocity" not in mesh.attributes)
obj.meniscus.sequence.outside = "NOTHING"
scene.frame_set(9)
check("outside of the sequence there is nothing", len(mesh.polygons) == 0)
obj.meniscus.sequence.outside = "HOLD"
scene.frame_set(9)
check("or its last frame", len(mesh.polygons) > 1000)

for preset in ("paper", "splashsurf", "smooth"):
    obj.meniscus.sequence.preset = preset
    scene.frame_set(1)
    check(f"the preset {preset} gives a surface", status.of(obj.name).kind == "INFO", status.of(obj.name))
obj.meniscus.sequence.viewport.uniform = True
scene.frame_set(1)
check("so does a uniform grid", status.of(obj.name).kind == "INFO", status.of(obj.name))

try:
    bpy.ops.meniscus.import_sequence(filepath=path("frames", "nothing_1.vtk"))
    reported = ""
except RuntimeError as error:
    reported = str(error)
check("importing what is not there is an error", "nothing_1.vtk is not there" in reported, reported)
bpy.ops.meniscus.clear_cache()
check("the cache is cleared", os.listdir(path("cache")) == [])
check("its limit is that of the preferences", preferences.cache_bytes() == 10 * 2**30)
end()
