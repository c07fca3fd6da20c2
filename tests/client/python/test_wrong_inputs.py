"""Wrong inputs of the tables in wrong/: each is refused with a message that helps, and nothing is broken by it."""

import re
import types

import meniscus
import pytest
from support.particles import particle_radius
from wrong.calls import CALLS
from wrong.frames import FRAMES
from wrong.settings import MACHINES, SETTINGS_ALONE


def named(table):
    return pytest.mark.parametrize("line", table, ids=[line.name for line in table])


def check(line, given):
    with pytest.raises(line.error) as raised:
        line.call(given)
    message = str(raised.value)
    for words in line.words:
        assert re.search(words, message), f"{message!r} does not say {words!r}"
    if isinstance(raised.value, meniscus.Error):
        assert "\n" not in message and "\0" not in message and len(message) < 2000


def test_the_tables_have_more_than_200_lines():
    tables = FRAMES + SETTINGS_ALONE + MACHINES + CALLS
    assert len(tables) >= 200


@pytest.fixture(scope="module")
def reconstructor():
    return meniscus.Reconstructor(particle_radius)


@named(FRAMES)
def test_a_reconstructor_refuses_and_goes_on(line, reconstructor, positions, mesh):
    check(line, reconstructor.reconstruct)
    assert reconstructor.reconstruct(positions).sha256() == mesh.sha256()


@named(FRAMES)
def test_the_function_refuses(line):
    check(line, lambda *given, **named: meniscus.reconstruct(*given, particle_radius=particle_radius, **named))


@named(SETTINGS_ALONE + MACHINES)
def test_a_reconstructor_is_not_made_with_wrong_settings(line):
    check(line, meniscus.Reconstructor)


@pytest.fixture(scope="module")
def place(server, mesh, positions, tmp_path_factory):
    """The objects of the calls, which all have been in use."""
    client = meniscus.Client(server.address)
    with client.session(particle_radius=particle_radius) as session, session.stream(waiting_limit=2) as stream:
        stream.push(positions)
        assert stream.next(60).mesh.sha256() == mesh.sha256()
        reconstructor = meniscus.Reconstructor(particle_radius)
        reconstructor.reconstruct(positions)
        yield types.SimpleNamespace(
            client=client,
            session=session,
            stream=stream,
            mesh=mesh,
            reconstructor=reconstructor,
            cpu=meniscus.Reconstructor(particle_radius, backend="cpu"),
        )
    client.close()


@named(SETTINGS_ALONE)
def test_a_session_is_not_opened_with_wrong_settings(line, place):
    before = {listed.id for listed in place.client.sessions()}
    check(line, place.client.session)
    assert {listed.id for listed in place.client.sessions()} == before


@named(CALLS)
def test_a_call_is_refused_and_its_object_goes_on(line, place, positions):
    check(line, place)
    assert place.session.info().id == place.session.id
    index = place.stream.push(positions)
    frame = place.stream.next(60)
    assert frame.index == index and frame.mesh.sha256() == place.mesh.sha256()


#: Whatever numbers hold is looked at by the server, whose refusal ends the stream.
LOOKED_AT_HERE = [line for line in FRAMES if not re.search("finite|farther|level 4", " ".join(line.words))]


@named(LOOKED_AT_HERE)
def test_a_stream_refuses_a_frame_of_a_wrong_form_and_goes_on(line, place, positions):
    check(line, place.stream.push)
    check(line, place.stream.try_push)
    index = place.stream.push(positions)
    assert place.stream.next(60).index == index


@named([line for line in FRAMES if line not in LOOKED_AT_HERE])
def test_a_stream_tells_of_values_that_the_server_refuses(line, client, positions):
    with client.session(particle_radius=particle_radius) as session:

        def push_and_take(*given, **named):
            with session.stream() as stream:
                stream.push(*given, **named)
                while stream.next(60) is not None:
                    pass

        check(line, push_and_take)
        with session.stream() as stream:
            stream.push(positions)
            assert stream.next(60).index == 0
