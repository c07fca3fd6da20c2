"""Objects that show sequences: what their settings ask for at a frame, and that put into their mesh."""

from dataclasses import replace

import bpy

from . import mesh_data, services, status
from .quiet import quiet
from .reconstruction import Request
from .sequence import MissingFile, Timing, gaps_text, span
from .worker import error_text


def objects(scene):
    return [obj for obj in scene.objects if obj.type == "MESH" and obj.meniscus.kind == "SEQUENCE"]


def timing(settings):
    return Timing(
        settings.first,
        max(settings.first, settings.last),
        settings.stride,
        settings.start,
        settings.speed,
        settings.outside == "HOLD",
    )


def request_of(obj, frame, quality):
    """The request for the object's surface at a frame; None: it shows none. quality: "viewport" or "render"."""
    settings = obj.meniscus.sequence
    if "{}" in settings.pattern:
        number = timing(settings).number(frame)
        if number is None:
            return None
    else:
        number = 0
    return Request(
        bpy.path.abspath(settings.pattern, library=obj.library),
        number,
        _short(settings.particle_radius),
        tuple(sorted(_keywords(settings, getattr(settings, quality)).items())),
        tuple(settings.attributes.replace(",", " ").split()),
        obj.meniscus.normals,
    )


def _keywords(settings, quality):
    """The keywords of meniscus.Reconstructor. One that would change nothing with a preset is refused there."""
    keywords = {"preset": settings.preset, "iso": _short(settings.iso), "cell_size": _short(quality.cell_size)}
    if settings.preset == "smooth":
        keywords["smoothness"] = int(quality.smoothness)
        keywords["spray"] = settings.spray
        if quality.uniform:
            keywords["mode"] = "uniform"
        else:
            keywords["tolerance"] = _short(quality.tolerance)
    return keywords


def _short(value):
    """Blender has float32: 0.6 is meant, not 0.6000000238."""
    return float(f"{value:.7g}")


def update(obj, frame, quality="viewport", waits=False):
    """Brings the object's mesh to a frame: now, or as soon as the worker has its surface. Errors become its status."""
    if obj.type != "MESH" or obj.meniscus.kind != "SEQUENCE" or services.worker is None or not _can_change(obj):
        return
    request = request_of(obj, frame, quality)
    if request is None:
        mesh_data.clear(obj.data)
        status.show(obj.name, "no file for this frame")
    elif waits:
        try:
            made = services.reconstruction.make(request)
        except MissingFile as error:
            # Of a film with many gaps the first one is told.
            _fail(obj, error_text(error), aloud=obj.name not in _gaps_told)
            _gaps_told.add(obj.name)
        except Exception as error:
            _fail(obj, error_text(error), aloud=True)
        else:
            _show(obj, made, aloud=True)
    else:
        services.worker.ask(obj.name, request)


def take_results():
    """Shows what the worker has made since. Gives whether anything has changed."""
    results = services.worker.take()
    for result in results:
        obj = bpy.data.objects.get(result.name)
        if obj is None or obj.type != "MESH" or obj.meniscus.kind != "SEQUENCE" or not _can_change(obj):
            continue
        wanted = request_of(obj, bpy.context.scene.frame_current, "viewport")
        # While an animation plays, the surface of an earlier frame is better than none.
        if wanted is None or replace(wanted, number=0) != replace(result.request, number=0):
            continue
        if result.error:
            _fail(obj, result.error)
        else:
            _show(obj, result.made)
    return bool(results)


def fill(obj, scene, quality):
    """Has the worker make the surfaces of all frames of the scene."""
    requests = [request_of(obj, frame, quality) for frame in range(scene.frame_start, scene.frame_end + 1)]
    services.worker.fill(obj.name, list(dict.fromkeys(request for request in requests if request is not None)))


def set_files(settings, numbers):
    """Sets the range of a pattern's files. Gives which numbers in it have none, in a sentence, or ""."""
    with quiet():
        settings.first, settings.last, settings.stride = span(numbers)
    gaps = gaps_text(numbers)
    (_gaps_told.add if gaps else _gaps_told.discard)(settings.id_data.name)
    return gaps


def follow_end(settings, scene):
    """Lets the scene end with the sequence, unless its end was set to another frame since."""
    end = max(scene.frame_start, timing(settings).end())
    if settings.scene_end == scene.frame_end:
        with quiet():
            settings.scene_end = end
        scene.frame_end = end


#: Names of objects of which it was told that files are missing.
_gaps_told = set()


def _show(obj, made, aloud=False):
    scale = obj.meniscus.velocity_scale
    key = f"{made.key} {scale:g}"
    if mesh_data.held(obj.data) != key:
        mesh_data.put(obj.data, key, made.surface, scale)
    warnings = made.surface.warnings or (
        (services.reconstruction.cache_error,) if services.reconstruction.cache_error else ()
    )
    if warnings:
        status.show(obj.name, warnings[0], "WARNING", made.surface.fitting_radius, aloud)
    else:
        status.show(obj.name, made.surface.text())


def _fail(obj, text, aloud=False):
    """An old surface at a new frame would be a lie: the mesh is emptied."""
    mesh_data.clear(obj.data)
    status.show(obj.name, text, "ERROR", aloud=aloud)


def _can_change(obj):
    obstacle = mesh_data.obstacle(obj)
    if obstacle:
        status.show(obj.name, obstacle, "WARNING")
    return not obstacle
