"""Messages name Python's keywords, and neither the command line's flags nor those of the wire."""

import meniscus
import pytest
from support import meniscusd


@pytest.mark.parametrize(
    "given, words",
    [
        ({"smoothing_length": 2}, ["smoothness", 'field="color"']),
        ({"field": "color", "smoothness": 6}, ["smoothing_length", 'field="smooth"']),
        ({"field": "color", "spray": "points"}, ['spray="keep"', 'field="smooth"']),
    ],
)
def test_settings_that_exclude_each_other_are_told_as_keywords(given, words):
    with pytest.raises(meniscus.InvalidInput) as raised:
        meniscus.Reconstructor(0.05, **given)
    assert all(word in str(raised.value) for word in words) and "--" not in str(raised.value)


@pytest.mark.parametrize("given, words", [(-1, "a whole number, 0 or more"), (10**6, "at most 1024")])
def test_a_number_of_threads_has_one_range(given, words):
    with pytest.raises(meniscus.InvalidInput, match=words):
        meniscus.Reconstructor(0.05, threads=given)


def test_bytes_are_no_numbers_and_are_not_shown():
    with pytest.raises(meniscus.InvalidInput, match="token is of type bytes, must be a text") as raised:
        meniscus.Client("127.0.0.1:1", token=b"secret")
    assert "secret" not in str(raised.value)


def test_a_file_that_is_too_large_names_the_keyword(positions, tmp_path):
    positions.tofile(tmp_path / "p.xyz")
    with pytest.raises(meniscus.LimitExceeded, match="max_bytes"):
        meniscus.read_particles(tmp_path / "p.xyz", max_bytes=100)


def test_the_viewers_port_is_told_from_the_servers():
    running = meniscus.Server(program=meniscusd.program)
    with running, pytest.raises(meniscus.ServerError) as raised:
        meniscus.Client(running.viewer.removeprefix("http://"))
    assert "speaks HTTP/1, as the port of a viewer or a proxy does" in str(raised.value)
    assert "50051" in str(raised.value) and "Trying to connect" not in str(raised.value)


def test_a_path_with_the_name_of_a_flag_stays_what_it_is():
    for path in "/nowhere/run--iso/f.vtk", "/nowhere/--field color.vtk", "a--smoothness.vtk":
        with pytest.raises(meniscus.InvalidInput) as raised:
            meniscus.read_particles(path)
        assert path in str(raised.value)


def test_a_recording_that_is_not_there_names_the_method_that_lists_them(client, session):
    with pytest.raises(meniscus.ServerError) as raised:
        client.read_recording(session, 1).next(60)
    assert "recordings()" in str(raised.value) and "ListRecordings" not in str(raised.value)


def test_an_id_that_is_none_is_told_without_the_wire(client):
    with pytest.raises(meniscus.InvalidInput) as raised:
        client.session(0.05, id="dam")
    assert all(word in str(raised.value) for word in ("id", "dam", "UUID"))
    assert "x-session" not in str(raised.value)
