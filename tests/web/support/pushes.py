"""Pushes the frames of a session one by one: pushes.py ADDRESS PARTICLES TILES COUNT. Prints the session's id, waits for a
line, then prints the index and the time of each push, seconds since the epoch. The water moves a little from frame to frame."""

import sys
import time

import numpy as np

import meniscus

address, path, tiles, count = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
radius = 0.025
one = meniscus.read_particles(path).positions
step = np.ptp(one, axis=0) + 4 * radius
side = int(np.ceil(np.sqrt(tiles)))
water = np.concatenate([one + step * (i % side, 0, i // side) for i in range(tiles)]).astype(np.float32)
client = meniscus.Client(address)
with client.session(particle_radius=radius) as session, session.stream(meshes=False) as stream:
    print(session.id, len(water), flush=True)
    sys.stdin.readline()
    for i in range(count):
        begun = time.time()
        stream.push(water + np.float32(0.37 * 0.5 * radius * i), time=0.01 * i)
        print(i, repr(begun), flush=True)
        # The page must be at rest when the next one comes.
        sys.stdin.readline()
