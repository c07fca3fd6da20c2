"""Coordinates of simulations in Blender, whose z is up: by the object's rotation and scale, which stay in sight."""

from math import pi

#: Euler angles (x, y, z) that turn an up axis upward.
_ROTATIONS = {"x": (0.0, -pi / 2, 0.0), "y": (pi / 2, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}

_METERS = {"km": 1000.0, "m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "um": 1e-6, "in": 0.0254, "ft": 0.3048}


def rotation(up_axis):
    """Angles; None for an axis that is not said."""
    return _ROTATIONS.get(up_axis)


def scale(length_unit, meters_per_blender_unit):
    """By how much the coordinates grow; None for a unit that is not known."""
    meters = _METERS.get(length_unit)
    return None if meters is None else meters / meters_per_blender_unit
