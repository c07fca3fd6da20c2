"""Operators of live sessions."""

import bpy

from . import live_objects, package, status
from .operators import cancelled, is_active, new_object
from .session_list import SessionList
from .worker import error_text


def _not_connected(operator, obj, error):
    """error: or its text."""
    text = error_text(error)
    status.show(obj.name, text, "ERROR")
    return cancelled(operator, text)


class AddLive(bpy.types.Operator):
    """Add an object that follows a live session of a meniscusd"""

    bl_idname = "meniscus.add_live"
    bl_label = "Meniscus Live Session"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        new_object(context, "Live Session", "LIVE")
        return {"FINISHED"}


class Connect(bpy.types.Operator):
    """Follow the session: the object shows its newest frame"""

    bl_idname = "meniscus.connect"
    bl_label = "Connect"

    @classmethod
    def poll(cls, context):
        return is_active(context, "LIVE")

    def execute(self, context):
        obj = context.object
        try:
            live_objects.connect(obj)
        except (package.PackageMissing, OSError) as error:
            return _not_connected(self, obj, error)
        if bpy.app.background and (text := live_objects.refusal(obj)):
            return _not_connected(self, obj, text)
        return {"FINISHED"}


class Disconnect(bpy.types.Operator):
    """Follow the session no longer; the last surface stays"""

    bl_idname = "meniscus.disconnect"
    bl_label = "Disconnect"

    @classmethod
    def poll(cls, context):
        return is_active(context, "LIVE") and live_objects.follower_of(context.object) is not None

    def execute(self, context):
        live_objects.disconnect(context.object)
        return {"FINISHED"}


class ListSessions(bpy.types.Operator):
    """Ask the server for its sessions, to choose one of them"""

    bl_idname = "meniscus.list_sessions"
    bl_label = "List Sessions"

    @classmethod
    def poll(cls, context):
        return is_active(context, "LIVE")

    def execute(self, context):
        obj = context.object
        try:
            asked = SessionList(live_objects.client_opener(obj.meniscus.live))
        except (package.PackageMissing, OSError) as error:
            return _not_connected(self, obj, error)
        name = obj.name
        status.show(name, "asking for sessions")

        def show():
            if not asked.done:
                return 0.1
            _show_sessions(name, asked)
            return None

        if bpy.app.background:
            asked.wait()
            show()
        else:
            bpy.app.timers.register(show)
        return {"FINISHED"}


def _show_sessions(name, asked):
    listed = bpy.context.window_manager.meniscus_sessions
    listed.clear()
    for key, text in asked.entries():
        entry = listed.add()
        entry.name, entry.description = key, text
    if asked.error:
        status.show(name, asked.error, "ERROR", aloud=bpy.app.background)
    else:
        status.show(name, "; ".join(entry.description for entry in listed) or "the server has no session")


CLASSES = (AddLive, Connect, Disconnect, ListSessions)
