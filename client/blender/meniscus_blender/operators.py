"""Operators of sequences and of the add-on itself."""

import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import package, sequence, sequence_objects, services, space, status, wheel
from .quiet import quiet

#: As meniscus.particle_extensions(), for a Blender that lacks the package.
_EXTENSIONS = (".vtk", ".vtu", ".vtp", ".ply", ".npy", ".npz", ".bgeo", ".bgeo.gz", ".h5", ".hdf5", ".h5part")
_MORE_EXTENSIONS = (".bi4", ".json", ".xyz", ".bin", ".raw")


def new_object(context, name, kind):
    """An object with an empty mesh, selected and active."""
    obj = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    obj.meniscus.kind = kind
    context.collection.objects.link(obj)
    for other in context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    # In a window, a frame of a render is changed in a thread of its own: nothing else may touch the mesh meanwhile.
    context.scene.render.use_lock_interface = True
    return obj


def is_active(context, kind):
    """Whether the active object is one of this kind."""
    obj = context.object
    return obj is not None and obj.type == "MESH" and obj.meniscus.kind == kind


def cancelled(operator, error):
    """Reports the error, and is what execute() returns then."""
    operator.report({"ERROR"}, str(error))
    return {"CANCELLED"}


class ImportSequence(bpy.types.Operator, ImportHelper):
    """Import files of SPH particles as an object that shows their surface at each frame"""

    bl_idname = "meniscus.import_sequence"
    bl_label = "Import SPH Particles"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(
        default=";".join("*" + extension for extension in _EXTENSIONS + _MORE_EXTENSIONS), options={"HIDDEN"}
    )
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    particle_radius: FloatProperty(
        name="Particle Radius",
        description="Half the distance between neighboring particles at rest, in the units of the file",
        default=0.025,
        min=1e-6,
        precision=5,
    )
    whole_sequence: BoolProperty(
        name="Whole Sequence", description="All files whose names differ in the number alone", default=True
    )
    up_axis: EnumProperty(
        name="Up Axis",
        description="Which axis of the file points upward; the object is turned so that Blender's z does",
        items=[("z", "Z", ""), ("y", "Y", ""), ("x", "X", "")],
    )
    scale: FloatProperty(name="Scale", description="Scale of the object", default=1.0, min=1e-6)
    set_frame_range: BoolProperty(name="Set Frame Range", description="The scene ends with the sequence", default=True)

    def execute(self, context):
        chosen = [os.path.join(self.directory, file.name) for file in self.files if file.name] or [self.filepath]
        path = bpy.path.abspath(chosen[0])
        if not os.path.isfile(path):
            return cancelled(self, f"{path} is not there")
        try:
            pattern = sequence.pattern_of(path) if self.whole_sequence or len(chosen) > 1 else path
            found = sequence.files(pattern) if "{}" in os.path.basename(pattern) else {}
        except sequence.SequenceError as error:
            return cancelled(self, error)
        if len(chosen) > 1:
            names = {os.path.basename(file) for file in chosen}
            found = {number: file for number, file in found.items() if os.path.basename(file) in names}
            if len(found) != len(names):
                return cancelled(self, "the names of the chosen files must differ in one number alone")
        name = os.path.basename(pattern).split(".")[0].replace("{}", "").strip("_-. ") or "Particles"
        obj = new_object(context, name, "SEQUENCE")
        settings = obj.meniscus.sequence
        gaps = ""
        with quiet():
            if found:
                gaps = sequence_objects.set_files(settings, found)
                settings.start = context.scene.frame_start
            settings.particle_radius = self.particle_radius
            settings.viewport.cell_size = 1.0
            settings.pattern = pattern
        obj.rotation_euler = space.rotation(self.up_axis)
        obj.scale = (self.scale,) * 3
        if found and self.set_frame_range:
            settings.scene_end = context.scene.frame_end
            sequence_objects.follow_end(settings, context.scene)
        if gaps:
            self.report({"WARNING"}, gaps)
        sequence_objects.update(obj, context.scene.frame_current, waits=bpy.app.background)
        shown = status.of(obj.name)
        if shown is not None and shown.kind == "ERROR":
            self.report({"ERROR"}, shown.text)
        return {"FINISHED"}


class RescanFiles(bpy.types.Operator):
    """Look for files that have come since, and set the range to all that are there"""

    bl_idname = "meniscus.rescan_files"
    bl_label = "Look for Files"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        return is_active(context, "SEQUENCE")

    def execute(self, context):
        settings = context.object.meniscus.sequence
        try:
            found = sequence.files(bpy.path.abspath(settings.pattern))
        except sequence.SequenceError as error:
            return cancelled(self, error)
        if not found:
            return cancelled(self, f"no file matches {settings.pattern}")
        gaps = sequence_objects.set_files(settings, found)
        sequence_objects.follow_end(settings, context.scene)
        sequence_objects.update(context.object, context.scene.frame_current, waits=bpy.app.background)
        self.report({"WARNING" if gaps else "INFO"}, f"{len(found)} files" + (f"; {gaps}" if gaps else ""))
        return {"FINISHED"}


class FillCache(bpy.types.Operator):
    """Reconstruct all frames of the scene, while Blender goes on"""

    bl_idname = "meniscus.fill_cache"
    bl_label = "Fill Cache"

    quality: EnumProperty(items=[("viewport", "Viewport", ""), ("render", "Render", "")])

    @classmethod
    def poll(cls, context):
        return is_active(context, "SEQUENCE") and services.worker is not None

    def execute(self, context):
        obj = context.object
        sequence_objects.fill(obj, context.scene, self.quality)
        if bpy.app.background:
            services.worker.wait()
            filling = services.worker.filling(obj.name)
            if filling.failed:
                return cancelled(self, f"{filling.failed} of {filling.total} frames failed: {filling.error}")
        return {"FINISHED"}


class StopFilling(bpy.types.Operator):
    """Stop filling the cache; what is there stays"""

    bl_idname = "meniscus.stop_filling"
    bl_label = "Stop"

    def execute(self, context):
        services.worker.stop_filling(context.object.name)
        return {"FINISHED"}


class UseFittingRadius(bpy.types.Operator):
    """Set the particle radius that fits the spacing of the particles"""

    bl_idname = "meniscus.use_fitting_radius"
    bl_label = "Use the Fitting Radius"
    bl_options = {"UNDO"}

    radius: FloatProperty(options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return is_active(context, "SEQUENCE")

    def execute(self, context):
        context.object.meniscus.sequence.particle_radius = float(f"{self.radius:.3g}")
        return {"FINISHED"}


class ClearCache(bpy.types.Operator):
    """Remove all surfaces from the cache"""

    bl_idname = "meniscus.clear_cache"
    bl_label = "Clear Cache"

    def execute(self, context):
        freed = services.reconstruction.cache.clear()
        self.report({"INFO"}, f"{freed / 2**20:.0f} MiB are free again")
        return {"FINISHED"}


class InstallWheel(bpy.types.Operator, ImportHelper):
    """Install the Python package meniscus from a wheel, among the modules of this Blender's user"""

    bl_idname = "meniscus.install_wheel"
    bl_label = "Install a Wheel of Meniscus"

    filter_glob: StringProperty(default="*.whl", options={"HIDDEN"})

    def execute(self, context):
        folder = bpy.utils.user_resource("SCRIPTS", path=os.path.join("addons", "modules"), create=True)
        was_there = not package.missing()
        try:
            wheel.install(self.filepath, folder)
            library = package.load_anew(folder)
        except (wheel.WheelError, package.PackageMissing, OSError) as error:
            return cancelled(self, error)
        advice = "start Blender anew to use it" if was_there else f"it is meniscus {library.__version__}"
        self.report({"INFO"}, f"the wheel is installed in {folder}: {advice}")
        return {"FINISHED"}


CLASSES = (ImportSequence, RescanFiles, FillCache, StopFilling, UseFittingRadius, ClearCache, InstallWheel)
