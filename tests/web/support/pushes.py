"""Pushes the frames of a session one by one: pushes.py ADDRESS PARTICLES NUMBER COUNT. Prints the session's id, then
for each line of its input the index and the time of a push, in seconds since the epoch. NUMBER particles: the file's,
side by side until there are as many. The water moves a little from frame to frame, so that no brick stays."""

import sys
import time

import meniscus
import numpy as np

address, path, number, count = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
radius = 0.025
one = meniscus.read_particles(path).positions
step = np.ptp(one, axis=0) + 4 * radius
tiles = -(-number // len(one))
side = int(np.ceil(np.sqrt(tiles)))
water = np.concatenate([one + step * (i % side, 0, i // side) for i in range(tiles)])[:number].astype(np.float32)
client = meniscus.Client(address)
with client.session(particle_radius=radius) as session, session.stream(meshes=False) as stream:
    print(session.id, flush=True)
    for i in range(count):
        if not sys.stdin.readline():
            break
        begun = time.time()
        stream.push(water + np.float32(0.37 * 0.5 * radius * i), time=0.01 * i)
        print(i, repr(begun), flush=True)
