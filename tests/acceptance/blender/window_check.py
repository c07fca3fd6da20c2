"""In a window: nothing blocks, surfaces come by themselves, a render runs beside; the panel is drawn."""

import os
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.environ["MENISCUS_CHECKS"])
from checks import check, check_picture, end, install_add_on, path, pixels  # noqa: E402

install_add_on()
from meniscus_blender import panel, services, status  # noqa: E402

bpy.context.preferences.addons["meniscus_blender"].preferences.cache_folder = path("window_cache")
bpy.context.preferences.view.show_splash = False


def window():
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0])


def water():
    return bpy.data.objects["frame"]


def steps():
    """Each yield lets Blender go on, until what is given holds."""
    scene = bpy.context.scene
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            area.spaces[0].show_region_ui = True
    for cls in reversed(panel.CLASSES):  # a script cannot choose a tab: the panels go to the one that is open
        bpy.utils.unregister_class(cls)
    panel._Panel.bl_category = "Item"
    for cls in panel.CLASSES:
        bpy.utils.register_class(cls)
    with window():
        begun = time.monotonic()
        bpy.ops.meniscus.import_sequence(filepath=path("frames", "frame_040.vtk"), particle_radius=0.025, up_axis="y")
    check("an import returns at once", time.monotonic() - begun < 0.5 and len(water().data.polygons) == 0)
    check("the interface is locked in renders", scene.render.use_lock_interface)
    yield lambda: len(water().data.polygons) > 1000
    check("the surface comes by itself", status.of("frame").kind == "INFO", status.of("frame"))
    first = len(water().data.polygons)

    begun = time.monotonic()
    scene.frame_set(2)
    check("so does a change of the frame", time.monotonic() - begun < 0.5)
    yield lambda: len(water().data.polygons) not in (0, first)
    second = len(water().data.polygons)

    water().meniscus.sequence.viewport.cell_size = 1.4
    yield lambda: 0 < len(water().data.polygons) < 0.9 * second
    check("a setting shows by itself", True)
    coarse = len(water().data.polygons)
    with window():
        bpy.ops.ed.undo_push(message="before")
        water().meniscus.sequence.viewport.cell_size = 1.0
        bpy.ops.ed.undo_push(message="after")
    yield lambda: len(water().data.polygons) == second
    with window():
        bpy.ops.ed.undo()
    yield lambda: len(water().data.polygons) == coarse
    check("undoing brings the surface of then", water().meniscus.sequence.viewport.cell_size > 1.3)

    with window():
        bpy.context.view_layer.objects.active = water()
        bpy.ops.meniscus.fill_cache(quality="render")
    yield lambda: services.worker.filling("frame").done == 3
    check("the cache is filled beside", services.worker.filling("frame").failed == 0)

    scene = bpy.context.scene  # undoing has made another one
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 8
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = 240, 180
    scene.render.use_motion_blur = True
    scene.render.filepath = path("pictures", "window_####")
    ended, seen = [], {}
    bpy.app.handlers.render_complete.append(lambda *_: ended.append(1))
    bpy.app.handlers.render_post.append(
        lambda scene, *_: seen.__setitem__(scene.frame_current, len(water().data.polygons))
    )
    with window():
        bpy.ops.render.render("INVOKE_DEFAULT", animation=True)
    yield lambda: ended
    check(
        "a render beside the window has every frame",
        len(set(seen.values())) == 3 and min(seen.values()) > 2 * coarse,
        seen,
    )
    for frame in (1, 2, 3):
        check_picture(f"from the window, frame {frame}", pixels(path("pictures", f"window_{frame:04d}.png")))
    yield lambda: 0 < len(water().data.polygons) < min(seen.values()) / 2
    check("after it the viewport has its own surface again", status.of("frame").kind == "INFO")

    water().meniscus.sequence.particle_radius = 0.005
    yield lambda: status.of("frame").kind == "WARNING"
    yield after(1.0)
    with window():
        bpy.ops.screen.screenshot(filepath=path("pictures", "window.png"))
    water().meniscus.sequence.pattern = path("frames", "nothing_{}.vtk")
    yield lambda: status.of("frame").kind == "ERROR"
    check("an error shows by itself", "nothing_{}.vtk" in status.of("frame").text and len(water().data.polygons) == 0)
    with window():
        bpy.ops.meniscus.add_live()
        bpy.context.object.meniscus.live.address = "unix:" + path("nowhere")
        bpy.ops.meniscus.connect()
    name = bpy.context.view_layer.objects.active.name
    yield lambda: status.of(name).kind == "ERROR"
    yield after(1.0)
    check("so does a server that is not there", "nowhere" in status.of(name).text, status.of(name))
    with window():
        bpy.ops.screen.screenshot(filepath=path("pictures", "window_live.png"))


def after(seconds):
    begun = time.monotonic()
    return lambda: time.monotonic() - begun > seconds


_run = steps()
_wait = {"holds": after(1.0), "until": time.monotonic() + 60}


def go_on():
    try:
        if not _wait["holds"]():
            if time.monotonic() > _wait["until"]:
                line = _run.gi_frame.f_lineno if _run.gi_frame else 0
                check(
                    f"window_check.py, line {line}: what is waited for comes within a minute", False, status._by_object
                )
                end()
            return 0.05
        _wait["holds"] = next(_run)
        _wait["until"] = time.monotonic() + 60
        return 0.05
    except StopIteration:
        end()
    except Exception:
        traceback.print_exc()
        check("the steps end without an exception", False, "above")
        end()


bpy.app.timers.register(go_on)
