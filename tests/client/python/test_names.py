"""Sessions and arrays by the names that people know."""

import uuid

import meniscus
import numpy as np
import pytest
from meniscus.named import Named, array_name
from support import command_line
from support.particles import particle_radius


@pytest.fixture
def named(client, positions):
    """A session with a name of its own, a frame in it, and a stream that stays open."""
    name = f"dam {uuid.uuid4()}"
    with client.session(particle_radius, name=name) as session, session.stream() as stream:
        stream.push(positions)
        assert stream.next(60) is not None
        yield name, session


def test_a_name_an_id_and_an_object_are_one_session(client, named):
    name, session = named
    for which in name, session.id, session, session.info(), client.session_info(name):
        assert client.session_info(which).id == session.id
        with client.watch(which) as watcher:
            frame = watcher.next(60)
        assert client.snapshot(which).mesh.sha256() == frame.mesh.sha256()
        with client.watch_particles(which) as watcher:
            assert watcher.next(60).index == frame.index


def test_a_stream_is_opened_by_a_name(client, positions):
    name = f"lake {uuid.uuid4()}"
    with client.session(particle_radius, name=name), client.stream(name) as stream:
        stream.push(positions)
        assert stream.next(60).index == 0


def test_a_session_is_deleted_by_its_name(client):
    name = f"pond {uuid.uuid4()}"
    session = client.session(particle_radius, name=name, ephemeral=False)
    client.delete_session(name)
    assert session.id not in {info.id for info in client.sessions()}


def test_a_recording_is_read_and_deleted_by_name_or_by_what_lists_it(client, positions):
    name = f"sea {uuid.uuid4()}"
    with client.session(particle_radius, name=name) as session, session.stream() as stream:
        stream.push(positions)
        sha256 = stream.next(60).mesh.sha256()
    listed = next(info for info in client.recordings() if info.name == name)
    for which in ((listed,), (name, 1), (listed.session_id, listed.number), (session, 1)):
        with client.read_recording(*which) as reader:
            assert reader.next(60).mesh.sha256() == sha256
    with pytest.raises(meniscus.InvalidInput, match="number is None, must be that of the recording"):
        client.read_recording(name)
    client.delete_recording(listed)
    with pytest.raises(meniscus.InvalidInput, match="no recorded session has the name or id"):
        client.read_recording(name, 1)


def test_an_unknown_name_is_refused_as_the_command_line_does(server, client, named, tmp_path):
    name, session = named
    with pytest.raises(meniscus.InvalidInput) as raised:
        client.watch("nope")
    text = str(raised.value)
    assert text.startswith('no session has the name or id "nope"; there are: ')
    assert f'"{name}" ({session.id})' in text or "more" in text
    failed = command_line.failed("watch", "nope", "--server", server.address, "-o", tmp_path)
    assert failed.rstrip().endswith(text)


def test_a_name_of_two_sessions_is_refused_with_their_ids(client):
    name = f"twin {uuid.uuid4()}"
    with client.session(particle_radius, name=name) as one, client.session(particle_radius, name=name) as other:
        with pytest.raises(meniscus.InvalidInput, match="2 sessions have the name") as raised:
            client.snapshot(name)
        assert one.id in str(raised.value) and other.id in str(raised.value)


def test_what_is_no_session_is_refused(client):
    for wrong in None, 5, b"dam", object():
        with pytest.raises(meniscus.InvalidInput, match="session is .*, must be a text"):
            client.watch(wrong)


LABELS = {"Temperature (K)": "temperature__k_", "Velocity": "velocity", "vorticity": "vorticity", "Über": "__ber"}


@pytest.mark.parametrize("label", LABELS)
def test_an_array_is_found_by_its_name_and_by_that_of_its_file(label, positions, tmp_path):
    name = LABELS[label]
    np.savez(tmp_path / "p.npz", positions=positions, **{label: positions[:, 0]})
    particles = meniscus.read_particles(tmp_path / "p.npz")
    assert list(particles.attributes) == [name] and array_name(label) == name
    assert particles.labels == ({} if label == name else {name: label})
    mesh = meniscus.reconstruct(particles.positions, particle_radius, attributes=particles.attributes)
    for attributes in particles.attributes, mesh.attributes:
        assert attributes[label] is attributes[name] and label in attributes and attributes.get(label) is not None


def test_labels_come_from_files_of_other_programs(tmp_path):
    (tmp_path / "p.vtp").write_text(
        """<VTKFile type="PolyData" version="1.0"><PolyData><Piece NumberOfPoints="1" NumberOfVerts="0">
        <PointData><DataArray type="Float32" Name="Temperature (K)" format="ascii">7</DataArray></PointData>
        <Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">1 2 3</DataArray></Points>
        </Piece></PolyData></VTKFile>"""
    )
    (tmp_path / "p.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float T\nproperty float Vorticity_x\nproperty float Vorticity_y\nproperty float Vorticity_z\n"
        "end_header\n1 2 3 7 4 5 6\n"
    )
    particles = meniscus.read_particles(tmp_path / "p.vtp")
    assert particles.labels == {"temperature__k_": "Temperature (K)"} and particles.attributes["Temperature (K)"] == 7
    particles = meniscus.read_particles(tmp_path / "p.ply")
    assert particles.labels == {"t": "T"} and particles.attributes["T"] == 7
    assert particles.attributes["Vorticity"].tolist() == [[4, 5, 6]], "of parts, the whole has no label of its own"


def test_attributes_are_asked_for_by_the_name_of_their_file(session, positions):
    reconstructor = meniscus.Reconstructor(particle_radius, attributes="Temperature (K)")
    assert reconstructor.settings["attributes"] == ["temperature__k_"]
    with session.stream(attributes={"Temperature (K)": 0}) as stream:
        stream.push(positions, attributes={"temperature__k_": positions[:, 0]})
        assert list(stream.next(60).mesh.attributes) == ["temperature__k_"]


def test_the_command_line_takes_the_name_of_the_file_too(positions, tmp_path):
    np.savez(tmp_path / "p.npz", positions=positions, **{"Temperature (K)": positions[:, 0]})
    flags = ["--attribute", "Temperature (K)"]
    command_line.reconstructed(tmp_path / "p.npz", tmp_path / "o.npz", particle_radius, *flags)
    assert "temperature__k_" in np.load(tmp_path / "o.npz")


def test_an_array_that_is_not_there_is_told_with_those_that_are():
    arrays = Named({"velocity": 1, "id": 2})
    assert "Pressure" not in arrays and arrays.get("Pressure", 3) == 3
    with pytest.raises(KeyError, match="'Pressure'; there are: velocity, id"):
        arrays["Pressure"]
