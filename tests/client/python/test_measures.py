"""What a mesh measures, and how it is shown."""

import re
import zlib

import meniscus
import numpy as np
import pytest
from support import closedness
from support.particles import ball, ball_volume, particle_radius


def test_volume_area_and_bounds_are_those_of_the_triangles(positions):
    mesh = meniscus.reconstruct(positions + np.float32([100.0, -3.0, 7.5]), particle_radius)
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert mesh.area == pytest.approx(np.linalg.norm(normals, axis=1).sum() / 2, rel=1e-9)
    assert mesh.volume == pytest.approx(closedness.volume(mesh), rel=1e-6)
    assert mesh.volume == pytest.approx(mesh.statistics.volume, rel=1e-12)
    assert mesh.bounds == pytest.approx(np.stack([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)]), rel=1e-15)


def test_a_ball_measures_what_a_ball_does():
    mesh = meniscus.reconstruct(ball(1.0), particle_radius)
    assert mesh.volume == pytest.approx(ball_volume(1.0), rel=0.1)
    assert mesh.area == pytest.approx(4 * np.pi, rel=0.15)
    assert np.abs(mesh.bounds).max() < 1.1


def test_an_empty_mesh_measures_nothing_and_has_no_bounds():
    mesh = meniscus.reconstruct(np.empty((0, 3)), particle_radius)
    assert mesh.area == mesh.volume == 0.0 and mesh.vertices32.shape == (0, 3)
    with pytest.raises(meniscus.InvalidInput, match="empty"):
        mesh.bounds


def test_vertices_of_float32_are_the_rounded_ones(mesh):
    assert mesh.vertices32.dtype == np.float32
    assert np.array_equal(mesh.vertices32, mesh.vertices.astype(np.float32))
    assert mesh.vertices32 is mesh.vertices32


def size_of(png):
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    return int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")


def data_of(png):
    """The numbers of the pixels' chunks."""
    data, place = b"", 8
    while place < len(png):
        length = int.from_bytes(png[place : place + 4], "big")
        if png[place + 4 : place + 8] == b"IDAT":
            data += png[place + 8 : place + 8 + length]
        place += 12 + length
    return zlib.decompress(data)


def test_a_picture_is_a_png_of_the_size_that_is_asked_for(positions):
    mesh = meniscus.reconstruct(positions, particle_radius, attributes={"velocity": positions})
    pictures = [
        mesh.png(90, 60),
        mesh.png(90, 60, color="velocity"),
        mesh.png(90, 60, up="z"),
        mesh.png(90, 60, wireframe=True),
    ]
    assert {size_of(picture) for picture in pictures} == {(90, 60)}
    assert len(set(pictures)) == 4
    assert all(len(set(data_of(picture))) > 20 for picture in pictures), "of one color"
    for wrong, words in (
        ({"color": "pressure"}, "pressure"),
        ({"up": "x"}, "up"),
        ({"width": 0}, "at least one"),
        ({"width": 10000}, "8192"),
        ({"height": -1}, "8192"),
    ):
        with pytest.raises(meniscus.InvalidInput, match=words):
            mesh.png(**wrong)


def test_a_notebook_shows_a_picture_and_the_figures(mesh):
    shown = mesh._repr_html_()
    assert re.search('<img src="data:image/png;base64,[A-Za-z0-9+/=]{1000,}"', shown)
    assert f"{len(mesh.triangles)} triangles" in shown
    empty = meniscus.reconstruct(np.empty((0, 3)), particle_radius)._repr_html_()
    assert "0 triangles" in empty and "<img" not in empty


def test_a_picture_that_takes_long_is_left_out(mesh, monkeypatch):
    monkeypatch.setattr("meniscus.mesh._MOST_DRAWN", len(mesh.triangles) - 1)
    assert "<img" not in mesh._repr_html_()


def test_what_is_printed_is_short(client, session, positions, tmp_path):
    np.savez(tmp_path / "p.npz", positions=positions, velocity=positions)
    count = f"{len(positions):,}"
    assert repr(meniscus.read_particles(tmp_path / "p.npz")) == f"<Particles: {count}, velocity>"
    with client.session(particle_radius, name="dam") as named, named.stream() as stream:
        stream.push(positions)
        frame = stream.next(60)
        assert repr(named.info()) == f'<Session "dam" live, 1 frame, {count} particles>'
        assert repr(frame.statistics).startswith(f"<Statistics: {count} particles, {len(frame.mesh.triangles):,} tri")
    assert repr(session.info()) == f"<Session {session.id} at rest, 0 frames>"
    assert re.fullmatch(r"<ServerInfo [\d.]+, cpu, \d+ threads>", repr(client.info()))
    listed = next(info for info in client.recordings() if info.session_id == named.id)
    assert re.fullmatch(r'<Recording 1 of "dam", 1 frame, [\d,]+ bytes(, being written)?>', repr(listed))
