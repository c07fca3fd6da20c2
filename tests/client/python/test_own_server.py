"""Servers that a program starts for itself, and the viewer in a notebook."""

import html
import os
import re
import time
import urllib.request

import meniscus
import pytest
from support import meniscusd
from support.particles import particle_radius
from support.scripts import run_script

pages = "http://localhost:8888"


@pytest.fixture(scope="module")
def started():
    with_server = meniscus.Server(program=meniscusd.program)
    yield with_server
    with_server.close()


def ends(address):
    """Whether the server does, which may be finishing yet."""
    deadline = time.monotonic() + meniscusd.deadline
    while time.monotonic() < deadline:
        try:
            meniscus.Client(address, timeout=5).info()
        except meniscus.ServerError:
            return True
    return False


def test_a_block_has_a_client_of_a_server_that_ends_with_it(positions, mesh):
    with meniscus.Server(program=meniscusd.program) as client:
        with client.session(particle_radius) as session, session.stream(normal_bits=0) as stream:
            stream.push(positions)
            assert stream.next(60).mesh.sha256() == mesh.sha256()
        address = client.address
    assert re.fullmatch(r"127\.0\.0\.1:\d+", address)
    with pytest.raises(meniscus.ServerError):
        meniscus.Client(address, timeout=5)


def test_two_servers_share_nothing(started):
    with meniscus.Server(program=meniscusd.program) as other, started.client() as client:
        assert other.address != client.address and other.viewer != client.viewer


def test_the_viewer_of_the_server_answers_and_lets_a_notebook_show_it(started):
    with urllib.request.urlopen(started.viewer, timeout=60) as answer:
        assert pages in answer.headers["Content-Security-Policy"]


def test_a_session_is_shown_in_a_frame_of_its_servers_viewer(started):
    with started.client() as client, client.session(particle_radius) as session:
        view = meniscus.show(session, color="velocity", height=300)
        assert view.address == f"{started.viewer}/?embed#session={session.id}&color=velocity"
        shown = view._repr_html_()
        assert f'<iframe src="{html.escape(view.address)}" style="width: 100%; height: 300px' in shown
        elsewhere = meniscus.show(session.info(), viewer="https://water.example/")
        assert elsewhere.address == f"https://water.example/?embed#session={session.id}"
        assert meniscus.show(session.info()).address.startswith("http://127.0.0.1:9464/?embed#")


def test_what_cannot_be_shown_is_refused(started):
    with started.client() as client, client.session(particle_radius) as session:
        with pytest.raises(meniscus.InvalidInput, match="session is 'dam', must be a Session"):
            meniscus.show("dam")
        for page in "127.0.0.1:9464", "javascript:alert(1)":
            with pytest.raises(meniscus.InvalidInput, match="must be the address of a page"):
                meniscus.show(session, viewer=page)
        assert "<script" not in meniscus.show(session, color='"><script>')._repr_html_()


def test_a_server_that_does_not_start_says_why():
    with pytest.raises(meniscus.ServerError, match="does not start: .*no-such-flag"):
        meniscus.Server("--no-such-flag", program=meniscusd.program)
    with pytest.raises(meniscus.ServerError, match="does not start: .*nowhere/meniscusd"):
        meniscus.Server(program="/nowhere/meniscusd")


@pytest.mark.parametrize("folder", ["/nowhere/lib/python3/dist-packages/meniscus", "/meniscus"])
def test_without_a_program_there_is_a_sentence(folder, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setattr("meniscus.server.__file__", f"{folder}/server.py")
    with pytest.raises(meniscus.InvalidInput, match="no meniscusd on PATH: install it, or give its path as program"):
        meniscus.Server()


def test_the_program_beside_the_package_or_on_path_is_taken(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", os.path.dirname(meniscusd.program) + ":" + os.environ["PATH"])
    with meniscus.Server() as client:
        assert client.serving()


LEFT_OPEN = """
    import os, sys, meniscus
    server = meniscus.Server(program=sys.argv[1])
    print(server.address, flush=True)
    client = server.client()
    {end}
"""


@pytest.mark.parametrize("end", ["sys.exit(0)", "1 / 0", "os._exit(0)", "os.kill(os.getpid(), 9)"])
def test_a_server_ends_with_its_program_however_that_ends(end):
    _, out, _ = run_script(LEFT_OPEN.replace("{end}", end), meniscusd.program)
    assert re.fullmatch(r"127\.0\.0\.1:\d+\n", out) and ends(out.strip())


def test_a_server_leaves_no_process_and_no_file_open():
    code, out, err = run_script(
        """
        import os, sys, meniscus
        with meniscus.Server(program=sys.argv[1]) as client:
            assert client.serving()
        try:
            os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            print("alone")
        """,
        meniscusd.program,
        flags=("-W", "error"),
    )
    assert (code, out, err) == (0, "alone\n", "")


def test_a_server_that_nobody_refers_to_any_more_ends():
    server = meniscus.Server(program=meniscusd.program)
    address = server.address
    assert server.client().serving()
    del server
    assert ends(address)
