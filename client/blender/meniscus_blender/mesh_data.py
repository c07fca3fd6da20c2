"""A surface in a mesh of Blender's. The data-block stays, and its materials with it; what it holds is replaced."""

import bpy
import numpy as np

#: A custom property of the mesh: the identity of the surface that it holds. It goes with the mesh through undo, copies
#: and files, so that what is in the mesh is known at any time.
_KEY = "meniscus_surface"

#: Attributes that Blender's meshes have a meaning for. An array of particles of this name gets "particle_" before it.
_TAKEN = frozenset(
    (
        "position",
        "normal",
        "radius",
        "material_index",
        "crease",
        "sharp_edge",
        "sharp_face",
        "shade_smooth",
        "custom_normal",
    )
)


def held(mesh):
    """The identity of the surface in a mesh; "" if it is none of ours."""
    return mesh.get(_KEY, "")


def obstacle(obj):
    """Why the object's mesh cannot be replaced now, and what to do; "" if it can."""
    if obj.data.library is not None:
        return "the mesh is linked from another file: make it local"
    if obj.data.shape_keys is not None:
        return "the mesh has shape keys, which fit one surface alone: remove them"
    if obj.mode != "OBJECT":
        return "the mesh is being edited: go back to Object Mode"
    return ""


def put(mesh, key, surface, velocity_scale=1.0):
    """Replaces what the mesh holds. velocity_scale: by which the attribute velocity is multiplied."""
    mesh.clear_geometry()
    count = len(surface.triangles)
    mesh.vertices.add(len(surface.vertices))
    mesh.vertices.foreach_set("co", surface.vertices.ravel())
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", surface.triangles.ravel())
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    if not bpy.types.MeshPolygon.bl_rna.properties["loop_total"].is_readonly:  # until Blender 3.5
        mesh.polygons.foreach_set("loop_total", np.full(count, 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(count, bool))
    for name, values in surface.attributes.items():
        _put_attribute(mesh, name, values * np.float32(velocity_scale) if name == "velocity" else values)
    mesh.update(calc_edges=True)
    has_normals = surface.normals is not None and count > 0
    if hasattr(mesh, "use_auto_smooth"):  # until Blender 4.0; its angle would split the surface
        mesh.use_auto_smooth = has_normals
        mesh.auto_smooth_angle = np.pi
    if has_normals:
        mesh.normals_split_custom_set_from_vertices(surface.normals)
    mesh[_KEY] = key


def clear(mesh):
    """Leaves the mesh without a surface."""
    mesh.clear_geometry()
    mesh.update()
    mesh[_KEY] = "empty"


def _put_attribute(mesh, name, values):
    """One attribute of the points; of bytes by three or four, a color."""
    components = 1 if values.ndim == 1 else values.shape[1]
    kind, field, data = _form(values, components)
    attribute = mesh.attributes.new("particle_" + name if name in _TAKEN else name, kind, "POINT")
    attribute.data.foreach_set(field, data.ravel())


def _form(values, components):
    if components == 1 and values.dtype == np.float32:
        return "FLOAT", "value", values
    if components == 1:
        return "INT", "value", values.astype(np.int32, casting="unsafe")  # ids beyond 2^31 become negative
    if values.dtype == np.uint8:
        return "BYTE_COLOR", "color_srgb", _with_alpha(values.astype(np.float32) / 255)
    if components == 3:
        return "FLOAT_VECTOR", "vector", values
    return "FLOAT_COLOR", "color", values


def _with_alpha(values):
    return values if values.shape[1] == 4 else np.hstack([values, np.ones((len(values), 1), np.float32)])
