"""Many ranks, one surface: each rank of an MPI job pushes the particles that it has, and the server joins them.

    mpirun -n 4 python3 parts_mpi.py 127.0.0.1:50051

Whatever a rank owns is right: slabs, any other decomposition, none at all; but no particle twice.
"""

import secrets
import sys

import numpy as np
from mpi4py import MPI

import meniscus

STEPS = 20
ranks = MPI.COMM_WORLD
address = sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1:50051"
client = meniscus.Client(address)

# Rank 0 makes the session, and the others join it.
session = client.session(particle_radius=0.025, name="ranks") if ranks.rank == 0 else None
session_id = ranks.bcast(session.id if session else None)
session = session or client.session(particle_radius=0.025, id=session_id)
run = ranks.bcast(secrets.randbits(63) + 1)  # that of rank 0: a number that this run alone has

x = np.stack(np.meshgrid(*[np.arange(0.1, 0.9, 0.05)] * 3), -1).reshape(-1, 3)  # metres: a cube of water
x = x[ranks.rank :: ranks.size]

with session, session.stream(part=ranks.rank, parts=ranks.size, run=run, reconnect=30) as stream:
    for step in range(STEPS):
        x += 0.01 * np.stack((0 * x[:, 0], 0 * x[:, 0], np.sin(3 * x[:, 0] + 0.3 * step)), -1)
        stream.push(x, time=0.1 * step)  # the same index and time on every rank
    stream.finish()
    for frame in stream:  # meshes at rank 0, figures alone at the others
        if ranks.rank == 0:
            print(f"frame {frame.index}: {frame.statistics.triangles} triangles", flush=True)
    ranks.Barrier()  # rank 0 ends the session
