"""Settings of an object, which are saved with the file."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import live_objects, sequence_objects
from .quiet import is_quiet

_SMOOTHNESS = [
    ("5", "Little", "Smoothness 5: the sharpest, and the fastest"),
    ("6", "Normal", "Smoothness 6"),
    ("7", "Much", "Smoothness 7: the smoothest, and the slowest"),
]


def _changed(self, context):
    """Shows what the settings now ask for; without windows, that is left to the next frame."""
    obj = self.id_data
    if isinstance(obj, bpy.types.Object) and not bpy.app.background and not is_quiet():
        sequence_objects.update(obj, context.scene.frame_current)


def _range_changed(self, context):
    if not is_quiet():
        sequence_objects.follow_end(self, context.scene)
    _changed(self, context)


def _normals_changed(self, context):
    _changed(self, context)
    if not bpy.app.background and not is_quiet():
        live_objects.connect_again(self.id_data)


class MeniscusQuality(bpy.types.PropertyGroup):
    """The properties that differ between the viewport and renders."""

    cell_size: FloatProperty(
        name="Cell Size",
        description="Edge of the finest cells, in particle radii: half of it takes some four times the triangles",
        default=0.5,
        min=0.05,
        soft_min=0.25,
        soft_max=2.0,
        max=100.0,
        update=_changed,
    )
    smoothness: EnumProperty(name="Smoothness", items=_SMOOTHNESS, default="6", update=_changed)
    uniform: BoolProperty(
        name="Uniform Grid",
        description="The finest cells everywhere, instead of larger ones where the surface is flat",
        update=_changed,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far the surface may depart from that of the finest cells, in finest cells",
        default=0.18,
        min=0.0,
        soft_max=1.0,
        update=_changed,
    )


class MeniscusSequence(bpy.types.PropertyGroup):
    """A sequence of files."""

    pattern: StringProperty(
        name="Files",
        description="Path with {} in place of the frame's number; // is the folder of the .blend file",
        subtype="FILE_PATH",
        update=_changed,
    )
    scene_end: IntProperty(options={"HIDDEN"})  # that the scene got from this sequence; 0: none
    first: IntProperty(name="First File", description="Number of the first file", min=0, update=_range_changed)
    last: IntProperty(name="Last File", description="Number of the last file", min=0, update=_range_changed)
    stride: IntProperty(
        name="Stride", description="From one file's number to the next", default=1, min=1, update=_range_changed
    )
    start: IntProperty(
        name="Start Frame",
        description="Frame of the scene that shows the first file",
        default=1,
        update=_range_changed,
    )
    speed: FloatProperty(
        name="Files per Frame",
        description="2 leaves out every second file; 0.5 holds each for two frames",
        default=1.0,
        min=0.001,
        soft_max=10.0,
        update=_range_changed,
    )
    outside: EnumProperty(
        name="Outside",
        description="What is shown before the first file and after the last one",
        items=[("HOLD", "Hold", "The first or the last file"), ("NOTHING", "Nothing", "An empty mesh")],
        update=_changed,
    )
    particle_radius: FloatProperty(
        name="Particle Radius",
        description="Half the distance between neighboring particles at rest, in the units of the file",
        default=0.025,
        min=1e-6,
        precision=5,
        update=_changed,
    )
    preset: EnumProperty(
        name="Preset",
        items=[
            ("smooth", "Smooth", "A field that follows each particle's neighborhood"),
            ("paper", "Paper", "The surface of Du and Kanai"),
            ("splashsurf", "splashsurf", "The surface of splashsurf without smoothing"),
        ],
        update=_changed,
    )
    iso: FloatProperty(
        name="Iso Value",
        description="Value of the field at the surface",
        default=0.6,
        min=0.01,
        soft_max=0.99,
        max=10.0,
        update=_changed,
    )
    spray: EnumProperty(
        name="Spray",
        description="What becomes of particles without company",
        items=[("keep", "Drops", "They become drops"), ("discard", "Left Out", "They are left out")],
        update=_changed,
    )
    attributes: StringProperty(
        name="Attributes",
        description="Arrays of the particles that the mesh gets: names with spaces between, or all",
        default="all",
        update=_changed,
    )
    viewport: PointerProperty(type=MeniscusQuality)
    render: PointerProperty(type=MeniscusQuality)


_tokens = {}  # by address: never saved, neither with the file nor with the preferences


class MeniscusLive(bpy.types.PropertyGroup):
    """A session of a meniscusd."""

    key: StringProperty(options={"HIDDEN"})  # of the follower
    address: StringProperty(
        name="Address", description="HOST:PORT, HOST for port 50051, or unix:PATH", default="127.0.0.1:50051"
    )
    session: StringProperty(name="Session", description="Name or id; empty: the only one that is there")
    token: StringProperty(
        name="Token",
        description="Sent with every call; forgotten when Blender ends, and not saved with the file",
        subtype="PASSWORD",
        get=lambda self: _tokens.get(self.address, ""),
        set=lambda self, value: _tokens.__setitem__(self.address, value),
    )
    token_file: StringProperty(
        name="Token File", description="File with the token, whose path is saved instead of it", subtype="FILE_PATH"
    )
    insecure: BoolProperty(name="Without TLS", description="Let the token travel to another machine without TLS")
    tls_ca: StringProperty(name="TLS CA", description="PEM file with who has signed the server", subtype="FILE_PATH")
    tls_cert: StringProperty(
        name="Certificate", description="PEM file of this client, for mutual TLS", subtype="FILE_PATH"
    )
    tls_key: StringProperty(name="Key", description="PEM file of this client, for mutual TLS", subtype="FILE_PATH")
    max_level: IntProperty(
        name="Finest Level", description="3: as reconstructed; below, the surface is coarser", default=3, min=1, max=3
    )
    attributes: StringProperty(name="Attributes", description="Names with spaces between, or all", default="all")
    takes_space: BoolProperty(
        name="Up Axis and Unit of the Session",
        description="When it connects, turn and scale the object as the session tells",
        default=True,
    )


class MeniscusObject(bpy.types.PropertyGroup):
    kind: EnumProperty(items=[("NONE", "None", ""), ("SEQUENCE", "Sequence", ""), ("LIVE", "Live Session", "")])
    normals: BoolProperty(
        name="Field Normals",
        description="Shade by the normals of the field, instead of those of the triangles: better, and slower to show",
        update=_normals_changed,
    )
    velocity_scale: FloatProperty(
        name="Velocity Scale",
        description="Simulated seconds that pass in a second of the film: motion blur is by velocity times this",
        default=1.0,
        update=_changed,
    )
    sequence: PointerProperty(type=MeniscusSequence)
    live: PointerProperty(type=MeniscusLive)


class MeniscusSession(bpy.types.PropertyGroup):
    """One of the list to choose from; its name is what chooses it."""

    description: StringProperty()


CLASSES = (MeniscusQuality, MeniscusSequence, MeniscusLive, MeniscusObject, MeniscusSession)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.meniscus = PointerProperty(type=MeniscusObject)
    bpy.types.WindowManager.meniscus_sessions = bpy.props.CollectionProperty(type=MeniscusSession)


def unregister():
    del bpy.types.WindowManager.meniscus_sessions
    del bpy.types.Object.meniscus
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
