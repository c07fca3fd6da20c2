#!/usr/bin/env python3
"""Compares two runs of one sequence: compare_streams.py LOCAL_DIR REMOTE_DIR LOCAL.json REMOTE.json

The exit code is 0 only if every frame has the same mesh_sha256 and every vertex normal of the remote PLY is within two
degrees of the local one at the same place."""

import json
import pathlib
import sys

import numpy as np


def read_vertices(path):
    """Positions and normals (n, 3), ordered by position, of a binary little-endian PLY."""
    with open(path, "rb") as file:
        properties, count, element = [], 0, None
        while (line := file.readline().split())[0] != b"end_header":
            if line[0] == b"element":
                element = line[1]
                count = int(line[2]) if element == b"vertex" else count
            elif line[0] == b"property" and element == b"vertex":
                properties.append((line[2].decode(), {"float": "<f4", "double": "<f8"}[line[1].decode()]))
        data = np.frombuffer(file.read(np.dtype(properties).itemsize * count), np.dtype(properties))
    positions = np.stack([data[k].astype(float) for k in ("x", "y", "z")], 1)
    normals = np.stack([data[k].astype(float) for k in ("nx", "ny", "nz")], 1)
    order = np.lexsort(positions.T)
    return positions[order], normals[order]


def main():
    local, remote = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    frames = [json.load(open(path))["frames"] for path in sys.argv[3:5]]
    if len(frames[0]) != len(frames[1]) or not frames[0]:
        sys.exit(f"{len(frames[0])} frames against {len(frames[1])}")
    for a, b in zip(*frames):
        if a["mesh_sha256"] != b["mesh_sha256"]:
            sys.exit(f"frame {a['frame']}: mesh_sha256 {a['mesh_sha256']} against {b['mesh_sha256']}")
    worst = 0.0
    paths = sorted(local.glob("*.ply"))
    for path in paths:
        (p, n), (q, m) = read_vertices(path), read_vertices(remote / path.name)
        if not np.array_equal(p, q):
            sys.exit(f"{path.name}: vertices differ")
        worst = max(worst, float(np.degrees(np.arccos(np.clip((n * m).sum(1), -1.0, 1.0))).max()))
    if len(paths) != len(frames[0]) or worst > 2.0:
        sys.exit(f"{len(paths)} meshes of {len(frames[0])} frames, largest angle between normals {worst:.2f} degrees")
    print(f"{len(paths)} frames equal, largest angle between normals {worst:.2f} degrees")


main()
