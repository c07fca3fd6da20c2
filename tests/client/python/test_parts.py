"""Frames that several streams push in parts."""

import threading

import meniscus
import numpy as np
import pytest
from support.particles import ball, particle_radius


def together(*works):
    """Runs all of them, each in a thread of its own; raises what one of them has raised."""
    raised = []

    def run(work):
        try:
            work()
        except BaseException as error:
            raised.append(error)

    threads = [threading.Thread(target=run, args=(work,)) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    if raised:
        raise raised[0]


def test_the_mesh_of_parts_is_that_of_the_whole_however_they_are_dealt_out(client):
    x = ball(3)
    marks = np.arange(len(x), dtype=np.uint32)
    whole = meniscus.reconstruct(x, particle_radius, attributes={"mark": marks})
    owner = np.random.default_rng(7).integers(0, 3, len(x))
    owner[owner == 1] = 2  # part 1 has none
    frames = [[], [], []]
    with client.session(particle_radius=particle_radius) as session:

        def rank(part):
            mine = owner == part
            with client.stream(session, part=part, parts=3, run=11) as stream:
                for step in range(2):
                    stream.push(x[mine], attributes={"mark": marks[mine]} if mine.any() else None, time=0.5 * step)
                stream.finish()
                frames[part].extend(stream)

        together(*(lambda part=part: rank(part) for part in range(3)))
    for of_part in frames:
        assert [frame.index for frame in of_part] == [0, 1]
        assert all(frame.statistics.particles == len(x) for frame in of_part)
    for frame in frames[0]:
        assert frame.mesh.sha256() == whole.sha256()
        assert sorted(frame.mesh.attributes["mark"]) == sorted(whole.attributes["mark"])
    with pytest.raises(meniscus.InvalidInput, match="has no mesh.*a part but 0"):
        frames[1][0].mesh


def test_one_part_that_is_wrong_ends_all_with_one_line(client):
    x = ball(5)
    with client.session(particle_radius=particle_radius) as session:

        def rank(part):
            with pytest.raises(meniscus.InvalidInput, match="simulation_time of part 1 is 1.*, and 0.* in part 0"):
                with client.stream(session, part=part, parts=2, run=12) as stream:
                    stream.push(x, time=float(part))

        together(lambda: rank(0), lambda: rank(1))


@pytest.mark.parametrize(
    "options, text",
    [
        ({"part": 2, "parts": 2, "run": 1}, "part is 2 of 2 parts; they are counted from 0"),
        ({"part": 1}, "part is 1 of 1 parts"),
        ({"parts": 2}, "run is 0, and parts is 2"),
        ({"parts": 100000, "run": 1}, "parts is 100000; the server at .* takes frames in at most 256"),
        ({"parts": -1, "run": 1}, "parts"),
    ],
)
def test_options_of_parts_that_cannot_be_are_refused(client, session, options, text):
    with pytest.raises(meniscus.InvalidInput, match=text):
        client.stream(session, **options)
