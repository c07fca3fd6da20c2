"""A program that makes the surface itself, and publishes it: the server shows it, and reconstructs nothing.

    python3 own_surface.py 127.0.0.1:50051
"""

import sys

import numpy as np

import meniscus

RADIUS = 0.025
client = meniscus.Client(sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1:50051")
reconstructor = meniscus.Reconstructor(RADIUS, keep_lattice=True)  # bricks are made of the lattice

x = np.stack(np.meshgrid(*[np.arange(0.1, 0.9, 0.05)] * 3), -1).reshape(-1, 3)  # metres: a cube of water

with client.session(RADIUS, name="own surface") as session, session.publish() as publisher:
    for step in range(20):
        x[:, 2] += 0.01 * np.sin(3 * x[:, 0] + 0.3 * step)
        publisher.push(reconstructor.reconstruct(x), time=0.1 * step)
        for answer in publisher.ready():  # that watchers have it
            print(f"frame {answer.index}: {answer.statistics.triangles} triangles", flush=True)
for answer in publisher.ready():  # the rest: the publisher's end has waited for them
    print(f"frame {answer.index}: {answer.statistics.triangles} triangles", flush=True)
