"""The panel in the sidebar of the 3D viewport, and the entries of menus."""

import bpy

from . import live_objects, package, services, status
from .preferences import draw_package, draw_text


#: By the kind of a status. Blender draws its icon ERROR as a warning.
_ICONS = {"INFO": "INFO", "WARNING": "ERROR", "ERROR": "CANCEL"}


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Meniscus"


class _ObjectPanel(_Panel):
    """A panel of an active object of one kind, with properties in two columns."""

    @classmethod
    def poll(cls, context):
        return _kind(context) == cls.kind

    def properties_layout(self):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        return layout


def _kind(context):
    obj = context.object
    return obj.meniscus.kind if obj is not None and obj.type == "MESH" else "NONE"


class MENISCUS_PT_main(_Panel, bpy.types.Panel):
    bl_label = "Meniscus"

    def draw(self, context):
        layout = self.layout
        if package.missing():
            draw_package(layout)
        column = layout.column(align=True)
        column.operator("meniscus.import_sequence", text="Import Sequence", icon="IMPORT")
        column.operator("meniscus.add_live", text="Live Session", icon="URL")
        if _kind(context) != "NONE":
            _draw_status(layout, context.object)


def _draw_status(layout, obj):
    shown = status.of(obj.name)
    if services.worker is not None and services.worker.is_making(obj.name):
        layout.label(text="reconstructing", icon="SORTTIME")
    if shown is not None:
        draw_text(layout, shown.text, _ICONS[shown.kind])
        if shown.fitting_radius > 0:
            text = f"Use {shown.fitting_radius:.3g}"
            layout.operator("meniscus.use_fitting_radius", text=text).radius = shown.fitting_radius


class MENISCUS_PT_sequence(_ObjectPanel, bpy.types.Panel):
    bl_label = "Sequence"
    bl_parent_id = "MENISCUS_PT_main"
    kind = "SEQUENCE"

    def draw(self, context):
        layout = self.properties_layout()
        settings = context.object.meniscus.sequence
        layout.prop(settings, "pattern")
        if "{}" in settings.pattern:
            column = layout.column(align=True)
            for name in ("first", "last", "stride"):
                column.prop(settings, name)
            layout.operator("meniscus.rescan_files", icon="FILE_REFRESH")
            column = layout.column(align=True)
            for name in ("start", "speed", "outside"):
                column.prop(settings, name)
        column = layout.column(align=True)
        for name in ("particle_radius", "preset", "iso"):
            column.prop(settings, name)
        if settings.preset == "smooth":
            column.prop(settings, "spray")
        column.prop(settings, "attributes")
        _draw_look(layout, context.object)


def _draw_look(layout, obj):
    column = layout.column(align=True)
    column.prop(obj.meniscus, "velocity_scale")
    column.prop(obj.meniscus, "normals")


class _QualityPanel(_ObjectPanel):
    kind = "SEQUENCE"
    bl_parent_id = "MENISCUS_PT_sequence"

    def draw(self, context):
        layout = self.properties_layout()
        settings = context.object.meniscus.sequence
        quality = getattr(settings, self.quality)
        layout.prop(quality, "cell_size")
        if settings.preset == "smooth":
            layout.prop(quality, "smoothness")
            layout.prop(quality, "uniform")
            if not quality.uniform:
                layout.prop(quality, "tolerance")
        layout.operator("meniscus.fill_cache", icon="FILE_CACHE").quality = self.quality


class MENISCUS_PT_viewport(_QualityPanel, bpy.types.Panel):
    bl_label = "Viewport"
    quality = "viewport"


class MENISCUS_PT_render(_QualityPanel, bpy.types.Panel):
    bl_label = "Render"
    quality = "render"

    def draw(self, context):
        super().draw(context)
        _draw_filling(self.layout, context.object.name)


def _draw_filling(layout, name):
    filling = services.worker.filling(name) if services.worker is not None else None
    if filling is None:
        return
    row = layout.row()
    row.label(text=f"{filling.done} of {filling.total} frames are in the cache", icon="SORTTIME")
    if filling.done < filling.total:
        row.operator("meniscus.stop_filling", text="", icon="CANCEL")
    if filling.failed:
        draw_text(layout, f"{filling.failed} failed: {filling.error}", "ERROR")


class MENISCUS_PT_live(_ObjectPanel, bpy.types.Panel):
    bl_label = "Live Session"
    bl_parent_id = "MENISCUS_PT_main"
    kind = "LIVE"

    def draw(self, context):
        layout = self.properties_layout()
        settings = context.object.meniscus.live
        is_connected = live_objects.follower_of(context.object) is not None
        column = layout.column(align=True)
        column.enabled = not is_connected
        column.prop(settings, "address")
        row = column.row(align=True)
        row.prop_search(settings, "session", context.window_manager, "meniscus_sessions")
        row.operator("meniscus.list_sessions", text="", icon="FILE_REFRESH")
        for name in ("max_level", "attributes", "takes_space"):
            column.prop(settings, name)
        _draw_look(layout, context.object)
        if is_connected:
            layout.operator("meniscus.disconnect", icon="UNLINKED")
        else:
            layout.operator("meniscus.connect", icon="LINKED")


class MENISCUS_PT_security(_ObjectPanel, bpy.types.Panel):
    bl_label = "Token and TLS"
    bl_parent_id = "MENISCUS_PT_live"
    bl_options = {"DEFAULT_CLOSED"}
    kind = "LIVE"

    def draw(self, context):
        layout = self.properties_layout()
        layout.enabled = live_objects.follower_of(context.object) is None
        for name in ("token", "token_file", "tls_ca", "tls_cert", "tls_key", "insecure"):
            layout.prop(context.object.meniscus.live, name)


def _import_menu(self, context):
    self.layout.operator("meniscus.import_sequence", text="SPH Particles (Meniscus)")


def _add_menu(self, context):
    self.layout.operator("meniscus.add_live", icon="URL")


CLASSES = (
    MENISCUS_PT_main,
    MENISCUS_PT_sequence,
    MENISCUS_PT_viewport,
    MENISCUS_PT_render,
    MENISCUS_PT_live,
    MENISCUS_PT_security,
)


def register():
    bpy.types.TOPBAR_MT_file_import.append(_import_menu)
    bpy.types.VIEW3D_MT_mesh_add.append(_add_menu)


def unregister():
    bpy.types.VIEW3D_MT_mesh_add.remove(_add_menu)
    bpy.types.TOPBAR_MT_file_import.remove(_import_menu)
