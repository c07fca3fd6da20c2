"""Connections with TLS and tokens, and how their refusals are reported."""

import meniscus
import pytest
from conftest import tokens
from support.particles import particle_radius
from test_server import refused


@pytest.fixture
def connect(secure_server, certificates):
    def connect(**changed):
        options = {
            "tls_ca": certificates / "ca.pem",
            "tls_cert": str(certificates / "me.pem"),
            "tls_key": certificates / "me.key",
            "token": tokens["admin"],
            **changed,
        }
        return meniscus.Client(secure_server.address, **options)

    return connect


def test_a_client_with_certificate_and_token_may_do_everything(connect, positions):
    with connect() as client, client.session(particle_radius=particle_radius) as session, session.stream() as stream:
        stream.push(positions)
        assert stream.next(60).index == 0
        assert session.info().owner == "admin-name"


def test_without_or_with_a_wrong_token_calls_are_unauthenticated(connect):
    for token in None, "somebody-else":
        with refused("unauthenticated", "UNAUTHENTICATED"), connect(token=token) as client:
            client.info()


def test_a_role_may_do_its_own_part(connect, positions):
    with connect(token=tokens["uploader"]) as uploader, connect(token=tokens["watcher"]) as watcher:
        with uploader.session(particle_radius=particle_radius) as session, session.stream() as stream:
            stream.push(positions)
            assert stream.next(60).index == 0
            with watcher.watch(session.id) as watching:
                assert watching.next(60).index == 0
            with refused("permission_denied", "PERMISSION_DENIED"):
                watcher.session(particle_radius=particle_radius)
            with refused("permission_denied"):
                watcher.delete_session(session.id)


def test_publishing_is_a_role_of_its_own(connect, positions):
    surface = meniscus.reconstruct(positions, particle_radius, keep_lattice=True)
    with connect(token=tokens["publisher"]) as publisher, publisher.session(particle_radius) as session:
        with session.publish() as publishing:
            publishing.push(surface)
        assert publisher.snapshot(session).mesh.sha256() == surface.sha256()
    with connect(token=tokens["uploader"]) as uploader, uploader.session(particle_radius) as session:
        with refused("permission_denied", "PERMISSION_DENIED"), session.publish() as publishing:
            publishing.push(surface)


def test_a_session_of_somebody_else_is_not_there(connect):
    with connect() as admin, admin.session(particle_radius=1.0) as session:
        with connect(token=tokens["uploader"]) as uploader, refused("not_found"):
            uploader.session_info(session.id)


@pytest.mark.parametrize("left_out", [["tls_ca", "tls_cert", "tls_key"], ["tls_cert", "tls_key"]])
def test_without_certificates_the_server_is_not_there(left_out, connect):
    with refused("unavailable"), connect(**{name: None for name in left_out}, timeout=5) as client:
        client.info()


def test_a_certificate_for_another_name_is_refused(connect):
    with refused("unavailable"):
        connect(tls_server_name="example.org", timeout=5).info()
    assert connect(tls_server_name="localhost").serving()


@pytest.mark.parametrize("end", ["\0", "\n", "\udc80", "é"])
def test_a_token_is_not_shown_where_it_is_refused(end):
    with pytest.raises(meniscus.InvalidInput, match="token") as refused:
        meniscus.Client("unix:/nobody", token="secret" + end)
    assert "secret" not in str(refused.value)


def test_a_token_is_not_shown(connect):
    client = connect()
    assert tokens["admin"] not in repr(client) + str(vars(client))
