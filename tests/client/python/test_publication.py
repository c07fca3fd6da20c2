"""Surfaces as plain files: what publish() writes is what open() reads, from a folder and from a host."""

import functools
import http.server
import json
import os
import re
import socketserver
import threading

import meniscus
import pytest
from support.particles import particle_radius


@pytest.fixture
def meshes(positions):
    reconstructor = meniscus.Reconstructor(particle_radius)
    return [reconstructor.reconstruct(positions[step:]) for step in range(3)]


@pytest.fixture
def host(tmp_path):
    """A plain web server of tmp_path."""
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(tmp_path))
    handler.log_message = lambda *_: None
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()
        thread.join()


def hashes(frames):
    return [frame.mesh.sha256() for frame in frames]


def test_meshes_are_read_back_from_a_folder_and_from_a_host(meshes, tmp_path, host):
    settings = meniscus.Reconstructor(particle_radius).settings
    written = meniscus.publish(meshes, tmp_path / "site", name="dam", up_axis="z", length_unit="m", settings=settings)
    for publication in written, meniscus.open(f"{host}/site"), meniscus.open(f"{host}/site/manifest.json"):
        assert (publication.name, publication.up_axis, publication.length_unit) == ("dam", "z", "m")
        assert publication.settings == settings and not publication.live
        assert len(publication) == 3 and publication.left_frames == 0
        assert hashes(publication) == [mesh.sha256() for mesh in meshes]
        assert [publication[place].index for place in (2, 0, -1)] == [2, 0, 2]


def test_it_goes_on_and_takes_no_frame_twice(meshes, tmp_path):
    meniscus.publish(meshes[:2], tmp_path / "site")
    publication = meniscus.publish(meshes, tmp_path / "site")
    assert hashes(publication) == [mesh.sha256() for mesh in meshes]
    with pytest.raises(meniscus.InvalidInput, match="other settings"):
        meniscus.publish(meshes, tmp_path / "site", settings={"particle_radius": particle_radius})


def test_frames_of_a_publication_are_published_as_they_are(meshes, tmp_path):
    first = meniscus.publish(meshes, tmp_path / "first")
    second = meniscus.publish(first, tmp_path / "second")
    assert hashes(second) == hashes(first)


def test_damage_is_refused(meshes, tmp_path):
    folder = tmp_path / "site"
    meniscus.publish(meshes, folder)
    (segment,) = (name for name in os.listdir(folder) if name.endswith(".segment"))
    whole = (folder / segment).read_bytes()
    for damaged in whole[:-1], whole[:-1] + b"\0", whole + b"\0":
        (folder / segment).write_bytes(damaged)
        with pytest.raises(meniscus.InvalidInput, match=segment):
            meniscus.open(folder).frame(0)
    (folder / "manifest.json").write_text("{}")
    with pytest.raises(meniscus.InvalidInput, match="not the manifest of a publication"):
        meniscus.open(folder)


def test_what_is_not_there_is_refused(meshes, tmp_path, host):
    for source in tmp_path / "nothing", f"{host}/nothing":
        with pytest.raises(meniscus.InvalidInput, match="manifest.json: cannot be read"):
            meniscus.open(source)
    publication = meniscus.publish(meshes, tmp_path / "site")
    for place in -1, 3, 1 << 70:
        with pytest.raises(meniscus.InvalidInput, match=f"no frame at the place {place}, but at 0 to 2"):
            publication.frame(place)
    with pytest.raises(IndexError):
        publication[3]
    with pytest.raises(meniscus.InvalidInput, match="must give a Frame or a Mesh"):
        meniscus.publish([1], tmp_path / "other")


def test_a_host_that_leads_to_another_is_not_followed(tmp_path):
    class Redirect(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(302)
            self.send_header("Location", "http://127.0.0.2/manifest.json")
            self.end_headers()

        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Redirect) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            with pytest.raises(meniscus.InvalidInput, match="another host, which is not followed"):
                meniscus.open(f"http://127.0.0.1:{server.server_address[1]}/")
        finally:
            server.shutdown()
            thread.join()


@pytest.mark.parametrize(
    "answer",
    [
        b"",
        b"no HTTP\r\n\r\n",
        b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nffff\r\n{",
        b"HTTP/1.1 200 OK\r\nContent-Length: 1000\r\n\r\n{",
        b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n{}",
    ],
)
def test_a_host_that_breaks_off_or_speaks_something_else_is_refused(answer):
    class Speaker(socketserver.StreamRequestHandler):
        def handle(self):
            while self.rfile.readline().strip():
                pass
            self.wfile.write(answer)

    with socketserver.TCPServer(("127.0.0.1", 0), Speaker) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            with pytest.raises(meniscus.InvalidInput):
                meniscus.open(f"http://127.0.0.1:{server.server_address[1]}/")
        finally:
            server.shutdown()
            thread.join()


def test_a_live_one_keeps_its_newest_frames(meshes, tmp_path):
    publication = meniscus.publish(meshes * 40, tmp_path / "site", keep=2)
    assert publication.left_frames > 0 and publication.left_frames + len(publication) == 120
    assert publication.frame(len(publication) - 1).index == 119


def test_a_notebook_shows_it(meshes, tmp_path):
    publication = meniscus.publish(meshes, tmp_path / "site", page=True)
    assert (tmp_path / "site" / "index.html").exists()
    shown = publication._repr_html_()
    assert re.match(r'<iframe srcdoc="&lt;!doctype html&gt;', shown)
    manifest = json.loads((tmp_path / "site" / "manifest.json").read_text())
    for segment in manifest["segments"]:
        assert f"data-file=&quot;{segment['sha256']}.segment&quot;" in shown
