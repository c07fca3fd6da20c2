"""Surfaces that were made in this process, for the watchers of a session."""

import asyncio
import pickle

import meniscus
import numpy as np
import pytest
from support.particles import ball, particle_radius
from test_parts import together


def reconstructor(**options):
    return meniscus.Reconstructor(particle_radius, keep_lattice=True, **options)


@pytest.fixture(scope="module")
def surface():
    return reconstructor().reconstruct(ball())


@pytest.mark.parametrize("codec", ["packed", "entropy"])
def test_watchers_see_the_mesh_that_was_published(client, session, codec):
    own = reconstructor()
    answers = []
    with client.watch(session, attributes={"mark": 0}) as watcher, session.publish(codec=codec) as publisher:
        for step in range(3):
            x = ball(0.3 + 0.1 * step)
            mesh = own.reconstruct(x, attributes={"mark": np.arange(len(x), dtype=np.uint32)})
            assert publisher.push(mesh, time=0.5 * step, index=10 + step) == 10 + step
            answers.append(publisher.next(60))
            seen = watcher.next(60)
            assert (seen.index, seen.time) == (10 + step, 0.5 * step)
            assert seen.mesh.sha256() == mesh.sha256() and seen.mesh.bricks_sha256() == mesh.bricks_sha256()
            assert sorted(seen.mesh.attributes["mark"]) == sorted(mesh.attributes["mark"])
            assert seen.statistics.particles == len(x) and seen.statistics.volume == mesh.statistics.volume
    assert [answer.index for answer in answers] == [10, 11, 12]
    with pytest.raises(meniscus.InvalidInput, match="has no mesh: it answers a publisher"):
        answers[0].mesh


def test_the_block_waits_for_all_answers(client, session, surface):
    with client.publish(session.id) as publisher:
        assert [publisher.push(surface) for _ in range(3)] == [0, 1, 2]
    assert [answer.index for answer in publisher.ready()] == [0, 1, 2] and publisher.ended
    assert publisher.dropped == 0
    assert session.info().frames == 3


def test_the_surface_of_one_call_is_published_too(client, session):
    mesh = meniscus.reconstruct(ball(), particle_radius, keep_lattice=True)
    with session.publish() as publisher:
        publisher.push(mesh)
    assert client.snapshot(session).mesh.sha256() == mesh.sha256()


def test_an_empty_surface_is_one(client, session):
    with session.publish() as publisher:
        publisher.push(reconstructor().reconstruct(np.empty((0, 3), np.float32)))
        assert publisher.next(60).statistics.triangles == 0
    assert len(client.snapshot(session).mesh.triangles) == 0


def test_the_bricks_of_two_publishers_are_one_surface(client, session):
    halves = [ball(center=(-4.0, 0.0, 0.0)), ball(0.4, center=(4.0, 0.0, 0.0))]
    whole = meniscus.reconstruct(np.concatenate(halves), particle_radius)
    answers = [[], []]

    def rank(part):
        with client.publish(session, part=part, parts=2, run=21) as publisher:
            own = reconstructor()
            for step in range(2):
                publisher.push(own.reconstruct(halves[part]), time=0.5 * step)
        answers[part].extend(publisher.ready())

    together(lambda: rank(0), lambda: rank(1))
    shown = client.snapshot(session)
    assert (shown.index, shown.time) == (1, 0.5)
    assert shown.mesh.sha256() == whole.sha256()
    for of_part in answers:
        assert [answer.index for answer in of_part] == [0, 1]
        assert all(answer.statistics.particles == sum(map(len, halves)) for answer in of_part)
        assert all(answer.statistics.triangles == len(whole.triangles) for answer in of_part)


def near(positions, lowest, highest, reach):
    """Those in a box and in a halo around it."""
    return positions[np.all((positions >= lowest - reach) & (positions <= highest + reach), axis=1)]


def test_ranks_with_halos_publish_the_bricks_that_are_their_own(client, session):
    x = ball(2.0)
    whole = meniscus.reconstruct(x, particle_radius)
    edge, reach, far = 64 * 0.5 * particle_radius, 27 * particle_radius, 1e9
    boxes = [((None, None, None), (-1, None, None)), ((0, None, None), (None, -1, None)), ([0, 0, None], 3 * [None])]
    ends = [([-far] * 3, [0, far, far]), ([0, -far, -far], [far, 0, far]), ([0, 0, -far], [far] * 3)]
    assert edge < 2.0
    answers = []

    def rank(part):
        mine = near(x, *map(np.array, ends[part]), reach)
        assert len(mine) < len(x)
        with client.publish(session, part=part, parts=3, run=5) as publisher:
            publisher.push(reconstructor().reconstruct(mine), bricks=boxes[part])
        answers.extend(publisher.ready())

    together(*(lambda part=part: rank(part) for part in range(3)))
    shown = client.snapshot(session)
    assert shown.mesh.sha256() == whole.sha256() and shown.mesh.bricks_sha256() == whole.bricks_sha256()
    assert [answer.statistics.triangles for answer in answers] == 3 * [len(whole.triangles)]
    assert shown.statistics.volume == pytest.approx(whole.statistics.volume, rel=1e-12)


@pytest.mark.parametrize(
    "bricks", [5, (1, 2), ((0, 0, 0),), ((0, 0), (1, 1)), ((0, 0, 0.5), (1, 1, 1)), "ab", (None, None)]
)
def test_a_box_that_is_none_is_refused_and_the_publisher_goes_on(session, surface, bricks):
    with session.publish() as publisher:
        with pytest.raises(meniscus.InvalidInput, match="bricks is .*, must be \\(lowest, highest\\)"):
            publisher.push(surface, bricks=bricks)
        assert publisher.push(surface) == 0


def test_a_box_without_bricks_is_a_part_of_a_surface(client, session, surface):
    with session.publish() as publisher:
        publisher.push(surface, bricks=((900, 0, 0), (901, 0, 0)))
        assert publisher.next(60).statistics.triangles == 0
        with pytest.raises(meniscus.InvalidInput, match="the lowest must not be beyond the highest"):
            publisher.push(surface, bricks=((2**31 - 1, 0, 0), (0, 0, 0)))
        with pytest.raises(meniscus.InvalidInput, match="bricks are chosen of a Mesh"):
            publisher.push(client.snapshot(session), bricks=((0, 0, 0), (1, 1, 1)))


def test_a_frame_of_a_file_passes_as_it_is(client, session, surface, tmp_path):
    with client.session(particle_radius) as other:
        with other.publish() as publisher:
            publisher.push(surface)
        client.snapshot(other, codec="entropy").mesh.save(tmp_path / "a.bricks")
    frame = meniscus.read_bricks(tmp_path / "a.bricks")
    with session.publish() as publisher:
        assert publisher.push(frame) == 0
        assert publisher.push(frame, time=2.5, index=7) == 7
    shown = client.snapshot(session)
    assert (shown.index, shown.time, shown.mesh.sha256()) == (7, 2.5, surface.sha256())
    assert shown.statistics.volume == frame.statistics.volume


def test_a_session_is_passed_on_to_another(client, session, positions):
    with session.stream() as stream, client.session(particle_radius) as other, other.publish() as publisher:
        with client.watch(session) as watcher:
            stream.push(positions, time=0.25)
            seen = watcher.next(60)
        publisher.push(seen)
        assert publisher.next(60).time == 0.25
        assert client.snapshot(other).mesh.sha256() == client.snapshot(session).mesh.sha256()


def test_a_task_publishes_and_takes_answers(session, surface):
    async def run():
        async with session.publish() as publisher:
            assert [await publisher.apush(surface, time=step) for step in (0, 1)] == [0, 1]
            publisher.finish()
            return [answer.index async for answer in publisher]

    assert asyncio.run(run()) == [0, 1]


def unlatticed(surface):
    return meniscus.reconstruct(ball(), particle_radius)


def pickled(surface):
    return pickle.loads(pickle.dumps(surface))


@pytest.mark.parametrize("made", [unlatticed, pickled])
def test_a_mesh_without_its_lattice_is_refused_and_the_publisher_goes_on(session, surface, made):
    with session.publish() as publisher:
        with pytest.raises(meniscus.InvalidInput, match="frame 0: the mesh has no lattice.*keep_lattice"):
            publisher.push(made(surface))
        assert publisher.push(surface) == 0
        assert publisher.next(60).index == 0


def test_what_is_no_surface_is_refused_and_the_publisher_goes_on(client, session, surface):
    with session.publish() as publisher:
        for nothing in None, 5, ball(), object():
            with pytest.raises(meniscus.InvalidInput, match="surface is of the type .*, must be a Mesh or a Frame"):
                publisher.push(nothing)
        publisher.push(surface, index=3)
        answer = publisher.next(60)
        with pytest.raises(meniscus.InvalidInput, match="has no mesh"):
            publisher.push(answer)
        for index, text in (3, "index is 3, must be at least 4"), (-1, "index"), ("x", "index"):
            with pytest.raises(meniscus.InvalidInput, match=text):
                publisher.push(surface, index=index)
        with pytest.raises(meniscus.InvalidInput, match="frame 4: simulation_time is inf"):
            publisher.push(surface, time=float("inf"))
        assert publisher.push(surface) == 4
        assert publisher.next(60).index == 4


def test_a_surface_of_other_settings_is_refused_by_the_server(client):
    x = ball()
    marked = reconstructor().reconstruct(x, attributes={"mark": np.zeros(len(x), np.float32)})
    coarse = reconstructor(cell_size=1.0).reconstruct(x)
    with client.session(particle_radius, attributes=[]) as session:
        for mesh, text in (coarse, "cell_size is .* with the session's settings"), (marked, "mark"):
            with pytest.raises(meniscus.InvalidInput, match=text), session.publish() as publisher:
                publisher.push(mesh)


@pytest.mark.parametrize(
    "options, text",
    [
        ({"part": 2, "parts": 2, "run": 1}, "part is 2 of 2 parts; they are counted from 0"),
        ({"parts": 2}, "run is 0, and parts is 2"),
        ({"codec": "zip"}, "codec.*zip"),
        ({"attribute_bits": 17}, "attribute_bits.*17"),
        ({"normal_bits": -1}, "normal_bits.*-1"),
        ({"meshes": False}, "meshes"),
        ({"on_reconnect": 5}, "on_reconnect is 5"),
    ],
)
def test_wrong_options_are_refused(session, options, text):
    with pytest.raises(meniscus.InvalidInput, match=text):
        session.publish(**options)


def test_a_session_takes_particles_or_surfaces(client, session, positions, surface):
    with session.stream() as stream:
        stream.push(positions)
        stream.next(60)
    with pytest.raises(meniscus.ServerError, match="takes frames of particles") as raised:
        with session.publish() as publisher:
            publisher.push(surface)
    assert raised.value.code == "failed_precondition"
    with client.session(particle_radius) as other:
        with other.publish() as publisher:
            publisher.push(surface)
        with pytest.raises(meniscus.ServerError, match="takes frames of bricks"):
            with other.stream() as stream:
                stream.push(positions)
