"""Servers, clients and particles for the tests of the Python package.

MENISCUSD and MENISCUS_CLI name the programs, PYTHONPATH the folder with the package as it was built. Neither program is
named where the build has none (-DMENISCUS_SERVICE=OFF): tests that need a server are skipped.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

import pytest

sys.path.insert(0, os.path.dirname(__file__))

import meniscus  # noqa: E402
from support import command_line, meniscusd  # noqa: E402
from support.meniscusd import Server  # noqa: E402
from support.particles import ball, particle_radius  # noqa: E402

repository = pathlib.Path(__file__).parents[3]
#: Lines of the file of tokens: role, name, token.
tokens = {role: f"{role}-of-these-tests" for role in ("uploader", "publisher", "watcher", "admin")}


has_service = meniscusd.program != "" or command_line.program != ""


def pytest_configure(config):
    for variable, program in ("MENISCUSD", meniscusd.program), ("MENISCUS_CLI", command_line.program):
        if has_service and not os.access(program, os.X_OK):
            raise pytest.UsageError(f"{variable} is '{program}', must be the path of the program")


@pytest.fixture
def socket_folder():
    """A folder with a short path, as the address of a Unix socket wants it."""
    with tempfile.TemporaryDirectory(prefix="meniscus-") as folder:
        yield folder


@pytest.fixture(scope="session")
def server():
    """One for all tests that leave it as it was. It records."""
    if not has_service:
        pytest.skip("this build has no server")
    with tempfile.TemporaryDirectory(prefix="meniscus-") as folder:
        running = Server(folder, "--record", f"{folder}/recordings", "--max-sessions", 200)
        yield running
        assert running.is_running(), "".join(running.log)
        running.stop()


@pytest.fixture
def client(server):
    with meniscus.Client(server.address) as connected:
        yield connected


@pytest.fixture
def session(client):
    with client.session(particle_radius=particle_radius) as opened:
        yield opened


@pytest.fixture
def own_server(socket_folder):
    """own_server(FLAG...): one for a single test, which may kill it."""
    started = []

    def start(*flags, listen=None):
        started.append(Server(socket_folder, *flags, listen=listen))
        return started[-1]

    yield start
    for one in started:
        one.kill()


@pytest.fixture(scope="session")
def certificates(tmp_path_factory):
    folder = tmp_path_factory.mktemp("certificates")
    subprocess.run(
        [repository / "deploy" / "dev-certificate", "--client", "me", folder], check=True, stdout=subprocess.DEVNULL
    )
    return folder


@pytest.fixture(scope="session")
def secure_server(certificates, tmp_path_factory):
    """Wants TLS with a client's certificate, and a token."""
    folder = tmp_path_factory.mktemp("secure")
    file = folder / "tokens"
    file.touch(mode=0o600)
    file.write_text("".join(f"{role} {role}-name {token}\n" for role, token in tokens.items()))
    flags = ["--tls-cert", certificates / "server.pem", "--tls-key", certificates / "server.key"]
    flags += ["--tls-client-ca", certificates / "ca.pem", "--tokens", file]
    running = Server(folder, *flags, listen="127.0.0.1:0")
    yield running
    running.stop()


@pytest.fixture(scope="session")
def positions():
    """A ball of some 500 particles; tests do not change it."""
    made = ball()
    made.flags.writeable = False
    return made


@pytest.fixture(scope="session")
def mesh(positions):
    return meniscus.reconstruct(positions, particle_radius)
