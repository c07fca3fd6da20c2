"""Whether triangles bound a solid."""

import numpy as np


def is_closed(triangles):
    """Whether each directed edge occurs once, and its reverse once: closed, manifold at edges, oriented."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    there = np.sort(edges[:, 0] << 32 | edges[:, 1])
    back = np.sort(edges[:, 1] << 32 | edges[:, 0])
    return len(np.unique(there)) == len(there) and np.array_equal(there, back)


def volume(mesh):
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)
