"""Frames of a ball that falls, for a job and for those that look at it."""

import numpy as np

from .particles import ball, particle_radius

__all__ = ["marks_of", "particle_radius", "particles_of"]


def particles_of(index):
    return ball(center=(0.0, -0.13 * index, 0.0))


def marks_of(index):
    return np.arange(len(particles_of(index)), dtype=np.uint32)
