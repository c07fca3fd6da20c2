"""A toy simulator in numpy, whose water a server turns into surfaces.

The viewer of the server (http://127.0.0.1:9464/, say) shows it. The last frame stays there until Enter is pressed, or,
where nobody can press it, for the seconds of --stay.
"""

import argparse
import sys
import time
from itertools import islice

import numpy as np

import meniscus

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("address", nargs="?", default="127.0.0.1:50051", help="of the server (default: %(default)s)")
parser.add_argument("--stay", type=float, default=0.0, metavar="SECONDS", help="to show the last frame; default 0")
options = parser.parse_args()

STEPS = 100


def tell(frame: meniscus.Frame) -> None:
    print(
        f"frame {frame.index}: {frame.statistics.triangles} triangles, volume {frame.statistics.volume:.3f}", flush=True
    )


client = meniscus.Client(options.address)
x = np.stack(np.meshgrid(*[np.arange(0.1, 0.9, 0.05)] * 3), -1).reshape(-1, 3)  # (4096, 3), metres: a cube of water

with client.session(particle_radius=0.025, name="numpy") as session, session.stream() as stream:
    told = 0
    for step in range(STEPS):
        a, b = np.pi * x[:, 0], np.pi * x[:, 2]  # vortices that keep the water's volume
        v = np.stack((np.sin(a) * np.cos(b), 0 * a, -np.cos(a) * np.sin(b)), -1)  # (4096, 3), metres per second
        x += v * 0.01
        stream.push(x, attributes={"velocity": v}, time=step * 0.01)
        for frame in stream.ready():
            tell(frame)
            told += 1
    for frame in islice(stream, STEPS - told):  # those that come at last
        tell(frame)
    if sys.stdin.isatty():
        input("The viewer shows the last frame. Enter ends the session. ")
    else:
        time.sleep(options.stay)
