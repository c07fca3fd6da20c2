"""A toy simulator in numpy, whose water a server turns into surfaces: numpy_simulator.py [ADDRESS]

The viewer of the server (http://127.0.0.1:9464/, say) shows it while it runs.
"""

import sys

import numpy as np

import meniscus

client = meniscus.Client(sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1:50051")
x = np.stack(np.meshgrid(*[np.arange(0.1, 0.9, 0.05)] * 3), -1).reshape(-1, 3)  # (4096, 3), metres: a cube of water

with client.session(particle_radius=0.025, name="numpy") as session, session.stream() as stream:
    for step in range(100):
        a, b = np.pi * x[:, 0], np.pi * x[:, 2]  # vortices that keep the water's volume
        v = np.stack((np.sin(a) * np.cos(b), 0 * a, -np.cos(a) * np.sin(b)), -1)  # (4096, 3), metres per second
        x += v * 0.01
        stream.push(x, attributes={"velocity": v}, time=step * 0.01)
        for frame in stream.ready():
            print(f"frame {frame.index}: {frame.statistics.triangles} triangles, volume {frame.statistics.volume:.3f}")
for frame in stream.ready():  # those that came at last
    print(f"frame {frame.index}: {frame.statistics.triangles} triangles, volume {frame.statistics.volume:.3f}")
