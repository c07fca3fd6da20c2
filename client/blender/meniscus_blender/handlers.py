"""When objects are brought up to date: as the frame changes, in renders, by a timer, after loading and undoing."""

import traceback

import bpy
from bpy.app.handlers import persistent

from . import live_objects, sequence_objects, services, status

_rendering = {}  # frame that is being rendered, by the name of its scene


def update_scene(scene, quality="viewport", waits=False, frame=None):
    for obj in sequence_objects.objects(scene):
        sequence_objects.update(obj, scene.frame_current if frame is None else frame, quality, waits)
    for obj in live_objects.objects(scene):
        live_objects.update(obj, waits)


@persistent
def _frame_changed(scene, *_):
    if scene.name in _rendering:
        # Cycles looks at moments before and after the frame, too. The surface has to stay: its vertices are others at
        # other frames, and the attribute velocity says where they move.
        update_scene(scene, "render", waits=True, frame=_rendering[scene.name])
    else:
        update_scene(scene, waits=bpy.app.background)


@persistent
def _render_begins(scene, *_):
    _rendering[scene.name] = scene.frame_current


@persistent
def _render_ended(scene, *_):
    _rendering.clear()
    if not bpy.app.background:
        update_scene(bpy.context.scene)  # from the surfaces of the render back to those of the viewport


@persistent
def _loaded(*_):
    """Another file: nothing of the last one goes on. A file by itself connects to no server."""
    services.stop_followers()
    status.forget()
    _rendering.clear()
    if not bpy.app.background:
        update_scene(bpy.context.scene)


@persistent
def _undone(*_):
    update_scene(bpy.context.scene)


def _tick():
    """Shows what the threads have made. Gives the seconds until it is called again."""
    if services.worker is None:
        return None
    if _rendering:
        if bpy.app.is_job_running("RENDER"):
            return 0.25  # nothing may change under a render
        _render_ended(bpy.context.scene)  # one that has failed, which calls no handler
    try:
        return _show_what_is_new()
    except Exception:
        traceback.print_exc()  # what is raised would end the timer
        return 1.0


def _show_what_is_new():
    was_busy = services.worker.is_busy
    changed = sequence_objects.take_results()
    follows = live_objects.update_all()
    if was_busy or changed or follows:
        _redraw_panels()
    return 0.05 if was_busy or follows else 0.25


def _redraw_panels():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


_HANDLERS = (
    ("frame_change_pre", _frame_changed),
    ("render_pre", _render_begins),
    ("render_complete", _render_ended),
    ("render_cancel", _render_ended),
    ("load_post", _loaded),
    ("undo_post", _undone),
    ("redo_post", _undone),
)


def register():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)
    bpy.app.timers.register(_tick, persistent=True)


def unregister():
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    for name, handler in _HANDLERS:
        listed = getattr(bpy.app.handlers, name)
        if handler in listed:
            listed.remove(handler)
    _rendering.clear()
