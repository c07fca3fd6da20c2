"""A Blender without the package meniscus: the add-on registers, says which wheel it needs, and installs that."""

import os
import sys
import zipfile

import bpy

sys.path.insert(0, os.environ["MENISCUS_CHECKS"])
from checks import check, end, install_add_on, path  # noqa: E402

install_add_on()
from meniscus_blender import package, status  # noqa: E402

check("the add-on is enabled", "meniscus_blender" in bpy.context.preferences.addons)
tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
try:
    package.meniscus()
    text = ""
except package.PackageMissing as error:
    text = str(error)
check("it names the wheel", f"meniscus-*-{tag}-{tag}-linux_" in text and "none is installed" in text, text)

try:
    bpy.ops.meniscus.import_sequence(filepath=path("frames", "frame_040.vtk"))
    reported = ""
except RuntimeError as error:
    reported = str(error)
obj = bpy.context.object
check("the import reports it", f"meniscus-*-{tag}" in reported, reported)
check("the object's status is the error", status.of(obj.name).kind == "ERROR" and tag in status.of(obj.name).text)

bpy.ops.meniscus.add_live()
try:
    bpy.ops.meniscus.connect()
    reported = ""
except RuntimeError as error:
    reported = str(error)
check("connecting reports it", f"meniscus-*-{tag}" in reported, reported)


def make_wheel(name):
    with zipfile.ZipFile(path(name), "w") as archive:
        for file in sorted(os.listdir(path("package", "meniscus"))):
            if os.path.isfile(path("package", "meniscus", file)):
                archive.write(path("package", "meniscus", file), "meniscus/" + file)
    return path(name)


try:
    bpy.ops.meniscus.install_wheel(filepath=make_wheel("meniscus-0.1.0-cp37-cp37m-linux_x86_64.whl"))
    reported = ""
except RuntimeError as error:
    reported = str(error)
check("a wheel for another Python is refused", "is for cp37 on linux_x86_64: this Blender needs" in reported, reported)

bpy.ops.meniscus.install_wheel(filepath=make_wheel(f"meniscus-0.1.0-{tag}-{tag}-linux_x86_64.whl"))
bpy.context.view_layer.objects.active = obj
bpy.context.scene.frame_set(1)
check("with the wheel the surface is there", len(obj.data.polygons) > 1000, status.of(obj.name))
check("and it is that of this Blender's user", "/bare/" in package.meniscus().__file__, package.meniscus().__file__)

bpy.ops.preferences.addon_disable(module="meniscus_blender")
check("the add-on leaves nothing behind", not hasattr(bpy.types.Object, "meniscus") and not bpy.app.handlers.render_pre)
end()
