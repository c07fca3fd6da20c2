"""Coordinates of simulations in Blender."""

import math

import pytest

from meniscus_blender import space


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_up_axis_points_upward(axis):
    up = [float(name == axis) for name in "xyz"]
    about_x, about_y, about_z = space.rotation(axis)
    assert about_z == 0
    sine, cosine = math.sin(about_x), math.cos(about_x)
    up = [up[0], cosine * up[1] - sine * up[2], sine * up[1] + cosine * up[2]]
    sine, cosine = math.sin(about_y), math.cos(about_y)
    up = [cosine * up[0] + sine * up[2], up[1], -sine * up[0] + cosine * up[2]]
    assert up == pytest.approx([0, 0, 1])


def test_an_axis_or_a_unit_that_is_not_said_changes_nothing():
    assert space.rotation("unspecified") is None and space.scale("", 1.0) is None and space.scale("parsec", 1.0) is None


def test_units_are_those_of_the_scene():
    assert space.scale("cm", 1.0) == pytest.approx(0.01)
    assert space.scale("m", 0.01) == pytest.approx(100)
