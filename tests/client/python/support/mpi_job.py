"""A job of several ranks that push parts of a ball that falls: python3 mpi_job.py ADDRESS SESSION FRAMES.

Each rank prints a line of JSON: what its pushes returned or raised, and its session.
"""

import json
import sys

from mpi4py import MPI

import meniscus
import meniscus.mpi
import numpy as np
from support.falling import marks_of, particle_radius, particles_of


def pushed(push):
    try:
        return push()
    except meniscus.Error as error:
        return [type(error).__name__, str(error)]


def trades_pieces(ranks):
    """Whether messages come whole that are longer than one of MPI, and of unequal lengths."""
    most, meniscus.mpi._MOST = meniscus.mpi._MOST, 10
    exchange = meniscus.mpi._Exchange(ranks)
    own, all_ranks = ranks.rank, range(ranks.size)
    traded = exchange.trade([bytes([own]) * (11 * own * to) for to in all_ranks])
    exchange.free()
    meniscus.mpi._MOST = most
    return traded == [bytes([by]) * (11 * by * own) for by in all_ranks]


def main(address, session, frames):
    ranks = MPI.COMM_WORLD
    results = [trades_pieces(ranks)]
    names = 5 if ranks.rank == ranks.size - 1 else "all"
    results.append(pushed(lambda: meniscus.mpi.Parts(ranks, particle_radius, server=address, attributes=names)))
    with meniscus.mpi.Parts(
        ranks, particle_radius, server=address, id=session, policy="every-frame", reconstruct_ranks="all"
    ) as parts:
        for index in range(frames):
            x, marks = particles_of(index), marks_of(index)
            owner = np.random.default_rng(index).integers(0, ranks.size, len(x))
            owner[owner == 1] = 0  # rank 1 has none
            mine = owner == ranks.rank
            results.append(pushed(lambda: parts.push(x[mine], attributes={"mark": marks[mine]}, time=0.5 * index)))
            if index == 0:
                wrong = np.full((1, 3), np.nan if ranks.rank == ranks.size - 1 else 0.0)
                one = {"mark": marks[:1]}
                results.append(pushed(lambda: parts.push(wrong, attributes=one)))
                shape = (1, 2) if ranks.rank == 0 else (1, 3)
                results.append(pushed(lambda: parts.push(np.zeros(shape), attributes=one)))
                results.append(pushed(lambda: parts.push(x, index="x" if ranks.rank == 0 else 9)))
        session_id, dropped = parts.session_id, parts.dropped
    lines = ranks.gather({"results": results, "session": session_id, "dropped": dropped})
    if ranks.rank == 0:
        print(json.dumps(lines))


main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
