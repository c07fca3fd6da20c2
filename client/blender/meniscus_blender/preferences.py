"""Preferences: the cache, and the Python package that does the work."""

import os
import sys

import bpy

from . import package


def default_cache_folder():
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or os.path.expanduser("~")
    elif sys.platform == "darwin":
        base = os.path.expanduser("~/Library/Caches")
    else:
        base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return os.path.join(base, "meniscus", "blender")


def _cache_changed(self, context):
    from . import services

    services.configure_cache(cache_folder(), cache_bytes())


class MeniscusPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    cache_folder: bpy.props.StringProperty(
        name="Cache Folder",
        description="Surfaces of sequences are kept here; empty: the user's folder for caches",
        subtype="DIR_PATH",
        update=_cache_changed,
    )
    cache_gib: bpy.props.FloatProperty(
        name="Cache Limit (GiB)",
        description="The least recently used surfaces go when there are more bytes of them",
        default=10.0,
        min=0.0,
        soft_max=1000.0,
        update=_cache_changed,
    )

    def draw(self, context):
        layout = self.layout
        draw_package(layout)
        layout.prop(self, "cache_folder")
        row = layout.row()
        row.prop(self, "cache_gib")
        row.operator("meniscus.clear_cache")


def draw_package(layout):
    """The package's version, or what is missing."""
    missing = package.missing()
    if missing:
        draw_text(layout, missing, "CANCEL")
        layout.operator("meniscus.install_wheel", icon="FILEBROWSER")
    else:
        layout.label(text=f"meniscus {package.meniscus().__version__}", icon="CHECKMARK")


def draw_text(layout, text, icon="INFO"):
    """A text in as many lines as it takes; labels have one each, and cut it."""
    column = layout.column(align=True)
    # Characters to a line: some 6.5 pixels each, beside the icon and the borders.
    region = bpy.context.region.width / bpy.context.preferences.system.ui_scale
    width = max(12, int((region - 70) / 6.5))
    line = ""
    for word in text.split():
        # Names of files have no spaces: they are cut, so that none is hidden.
        pieces = [word[i : i + width] for i in range(0, len(word), width)]
        for piece in pieces:
            if line and len(line) + 1 + len(piece) > width:
                column.label(text=line, icon=icon)
                line, icon = piece, "BLANK1"
            else:
                line = f"{line} {piece}" if line else piece
    column.label(text=line, icon=icon)


def _own():
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def cache_folder():
    own = _own()
    return bpy.path.abspath(own.cache_folder) if own and own.cache_folder else default_cache_folder()


def cache_bytes():
    own = _own()
    return int((own.cache_gib if own else 10.0) * 2**30)
