"""Particles of known shapes, as float32 of (N, 3)."""

import math

import numpy as np

particle_radius = 0.05


def ball(radius=0.5, center=(0.0, 0.0, 0.0)):
    """A lattice with a spacing of two particle radii, inside a sphere."""
    side = np.arange(-radius, radius + particle_radius, 2 * particle_radius)
    grid = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
    inside = np.linalg.norm(grid, axis=1) <= radius
    return (grid[inside] + center).astype(np.float32)


def ball_volume(radius=0.5):
    return 4.0 / 3.0 * math.pi * radius**3


def crowd(count):
    """Random particles, enough that a frame of them can be interrupted."""
    side = 2 * particle_radius * count ** (1 / 3)
    return np.random.default_rng(7).random((count, 3), dtype=np.float32) * np.float32(side)
