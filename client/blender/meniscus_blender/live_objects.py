"""Objects that follow live sessions: their followers, and the newest frame put into their mesh."""

import os
import uuid

import bpy

from . import live, mesh_data, package, services, space, status

#: Seconds that a render waits for a session's first frame.
_FIRST_FRAME_SECONDS = 60.0

#: Seconds in which a server answers: more than its client waits.
_ANSWER_SECONDS = 15.0

#: Codes of meniscus.ServerError with which another attempt gives the same answer.
_FINAL_CODES = ("unauthenticated", "permission_denied", "unimplemented")


def objects(scene):
    return [obj for obj in scene.objects if obj.type == "MESH" and obj.meniscus.kind == "LIVE"]


def follower_of(obj):
    """None: the object is not connected."""
    return services.followers.get(obj.meniscus.live.key)


def connect(obj):
    """Begins to follow, in place of what was followed. Raises PackageMissing, OSError for the token's file."""
    disconnect(obj)
    settings = obj.meniscus.live
    library = package.meniscus()
    open_client = client_opener(settings)
    target = live.Target(
        settings.session.strip(),
        settings.max_level,
        tuple(settings.attributes.replace(",", " ").split()),
        obj.meniscus.normals,
    )

    def is_final(error):
        if isinstance(error, library.ServerError):
            return error.code in _FINAL_CODES
        return isinstance(error, library.InvalidInput)

    settings.key = str(uuid.uuid4())
    services.followers[settings.key] = live.Follower(open_client, target, final=is_final)
    status.show(obj.name, "connecting")


def refusal(obj):
    """Waits for the server's first answer. Gives the error that no wait mends, such as several sessions of which none
    is chosen, and follows no longer then; "" where there is none."""
    text = follower_of(obj).wait_for_answer(_ANSWER_SECONDS)
    if text:
        services.followers.pop(obj.meniscus.live.key).stop(seconds=0.0)
    return text


def client_opener(settings):
    """A function that opens a client, for another thread, in which settings must not be read."""
    library = package.meniscus()
    token = settings.token or os.environ.get("MENISCUS_TOKEN", "")
    if settings.token_file:
        with open(bpy.path.abspath(settings.token_file), encoding="utf-8") as file:
            token = file.read().strip()
    options = {
        name: bpy.path.abspath(value)
        for name in ("tls_ca", "tls_cert", "tls_key")
        if (value := getattr(settings, name))
    }
    address, insecure = settings.address.strip(), settings.insecure
    return lambda: library.Client(address, token=token or None, insecure=insecure, **options)


def disconnect(obj):
    """The object keeps the last surface."""
    follower = services.followers.pop(obj.meniscus.live.key, None)
    if follower is not None:
        follower.stop(seconds=0.0)  # one that is connecting ends when it has
        status.show(obj.name, "disconnected")


def update(obj, waits=False):
    """Shows the newest frame. waits: until there is a first one."""
    follower = follower_of(obj)
    if follower is None:
        return
    obstacle = mesh_data.obstacle(obj)
    if obstacle:
        status.show(obj.name, obstacle, "WARNING")
        return
    frame = follower.wait(_FIRST_FRAME_SECONDS) if waits else follower.newest
    if frame is not None:
        scale = obj.meniscus.velocity_scale
        key = f"{frame.key} {scale:g}"
        if mesh_data.held(obj.data) != key:
            _take_space(obj, follower)
            mesh_data.put(obj.data, key, frame.surface, scale)
    state = follower.state
    status.show(obj.name, state.text, "ERROR" if state.is_error else "INFO", aloud=waits)


def connect_again(obj):
    """After a setting has changed on which the surfaces depend that the follower asks for."""
    if obj.meniscus.kind == "LIVE" and follower_of(obj) is not None:
        connect(obj)


def update_all():
    """Updates the live objects of every scene. Ends followers whose objects are gone. Gives whether there are any."""
    if not services.followers:
        return False
    found = set()
    for obj in bpy.data.objects:
        if obj.type == "MESH" and obj.meniscus.kind == "LIVE" and follower_of(obj) is not None:
            found.add(obj.meniscus.live.key)
            update(obj)
    for key in set(services.followers) - found:
        services.followers.pop(key).stop(seconds=0.0)
    return True


def _take_space(obj, follower):
    """Takes the session's axes and unit over, once for each connection: the user's later changes stay."""
    if not obj.meniscus.live.takes_space or follower.space is None or follower.space_taken:
        return
    follower.space_taken = True
    angles = space.rotation(follower.space.up_axis)
    if angles is not None:
        obj.rotation_mode = "XYZ"
        obj.rotation_euler = angles
    factor = space.scale(follower.space.length_unit, bpy.context.scene.unit_settings.scale_length)
    if factor is not None:
        obj.scale = (factor, factor, factor)
