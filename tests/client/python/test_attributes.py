"""Arrays of the particles reach the vertices, in process and through a server."""

import meniscus
import numpy as np
import pytest
from support.particles import particle_radius

FORMS = [
    (np.float32, ()),
    (np.float32, (3,)),
    (np.float32, (4,)),
    (np.uint8, ()),
    (np.uint8, (3,)),
    (np.uint8, (4,)),
    (np.int32, ()),
    (np.uint32, ()),
]


def constant(dtype, components, count):
    values = np.arange(2, 6)[: components[0]] if components else np.array(7)
    return np.broadcast_to(values, (count, *components)).astype(dtype)


@pytest.mark.parametrize(("dtype", "components"), FORMS)
def test_a_constant_is_that_constant_at_every_vertex(dtype, components, positions, mesh):
    given = constant(dtype, components, len(positions))
    with_it = meniscus.reconstruct(positions, particle_radius, attributes={"carried": given})
    found = with_it.attributes["carried"]
    assert found.dtype == dtype and found.shape == (len(with_it.vertices), *components)
    assert (found == given[0]).all()
    assert with_it.sha256() == mesh.sha256()
    assert repr(with_it).endswith("triangles, carried>")


def test_a_linear_field_is_about_itself_at_the_vertices(positions):
    mesh = meniscus.reconstruct(positions, particle_radius, attributes={"place": positions})
    inward = mesh.attributes["place"]
    assert np.abs(inward - mesh.vertices).max() < 3 * particle_radius
    assert np.corrcoef(inward[:, 0], mesh.vertices[:, 0])[0, 1] > 0.99


def test_ids_are_those_of_particles_nearby_and_never_averaged(positions):
    ids = np.arange(len(positions), dtype=np.int32) * 1000 - 5
    mesh = meniscus.reconstruct(positions, particle_radius, attributes={"id": ids})
    found = mesh.attributes["id"]
    assert np.isin(found, ids).all()
    nearest = positions[(found + 5) // 1000]
    assert np.linalg.norm(nearest - mesh.vertices, axis=1).max() < 4 * particle_radius


@pytest.mark.parametrize(
    ("given", "dtype"),
    [
        (np.float64, np.float32),
        (np.float16, np.float32),
        (">f4", np.float32),
        (bool, np.uint8),
        (np.int8, np.int32),
        (np.int16, np.int32),
        (np.int64, np.int32),
        (np.uint16, np.int32),
        (np.uint64, np.uint32),
        (">i4", np.int32),
    ],
)
def test_other_types_become_the_nearest_that_attributes_have(given, dtype, positions):
    values = np.ones(len(positions), given)
    found = meniscus.reconstruct(positions, particle_radius, attributes={"carried": values}).attributes["carried"]
    assert found.dtype == dtype and (found == 1).all()


def test_a_column_of_one_component_is_as_one_without(positions):
    values = np.ones((len(positions), 1), np.float32)
    found = meniscus.reconstruct(positions, particle_radius, attributes={"carried": values}).attributes["carried"]
    assert found.shape == (len(found),)


@pytest.mark.parametrize("form", [np.asfortranarray, lambda v: np.hstack([v, v])[:, :3], lambda v: v[::-1][::-1], list])
def test_attributes_of_every_layout_give_the_same(form, positions):
    velocity = positions * 3
    expected = meniscus.reconstruct(positions, particle_radius, attributes={"velocity": velocity})
    found = meniscus.reconstruct(positions, particle_radius, attributes={"velocity": form(velocity)})
    assert np.array_equal(found.attributes["velocity"], expected.attributes["velocity"])


def test_a_reconstructor_takes_the_attributes_that_it_names(positions):
    reconstructor = meniscus.Reconstructor(particle_radius, attributes=["age"])
    ones = np.ones(len(positions), np.float32)
    mesh = reconstructor.reconstruct(positions, attributes={"age": ones, "other": ones})
    assert set(mesh.attributes) == {"age"}
    with pytest.raises(meniscus.InvalidInput, match="'age'"):
        reconstructor.reconstruct(positions, attributes={"other": ones})
    assert set(reconstructor.reconstruct(positions, attributes={"age": ones}).attributes) == {"age"}


def test_all_stands_for_those_of_the_first_frame(positions):
    reconstructor = meniscus.Reconstructor(particle_radius)
    ones = np.ones(len(positions), np.float32)
    assert set(reconstructor.reconstruct(positions, attributes={"age": ones}).attributes) == {"age"}
    with pytest.raises(meniscus.InvalidInput, match="'age'"):
        reconstructor.reconstruct(positions)
    mesh = reconstructor.reconstruct(positions, attributes={"age": ones, "later": ones})
    assert set(mesh.attributes) == {"age"}


def test_sixteen_attributes_are_possible_and_no_more(positions):
    ones = np.ones(len(positions), np.float32)
    many = {f"a{i}": ones * i for i in range(16)}
    mesh = meniscus.reconstruct(positions, particle_radius, attributes=many)
    assert all((mesh.attributes[f"a{i}"] == i).all() for i in range(16))
    with pytest.raises(meniscus.LimitExceeded, match="16"):
        meniscus.reconstruct(positions, particle_radius, attributes={**many, "b": ones})


def test_exact_attributes_come_from_a_server_as_in_process(session, positions):
    rng = np.random.default_rng(3)
    given = {
        "velocity": rng.normal(size=(len(positions), 3)).astype(np.float32),
        "color": rng.integers(0, 255, (len(positions), 4)).astype(np.uint8),
        "id": rng.permutation(len(positions)).astype(np.uint32),
    }
    here = meniscus.reconstruct(positions, particle_radius, attributes=given)
    with session.stream(attribute_bits=0, normal_bits=16) as stream:
        stream.push(positions, attributes=given)
        there = stream.next(60)
    assert there.mesh.sha256() == here.sha256()
    order = np.lexsort(here.lattice.T), np.lexsort(there.mesh.lattice.T)
    assert np.array_equal(here.lattice[order[0]], there.mesh.lattice[order[1]])
    for name in given:
        assert np.array_equal(here.attributes[name][order[0]], there.mesh.attributes[name][order[1]]), name


def test_a_receiver_chooses_attributes_and_their_bits(session, positions):
    age = np.linspace(0, 1, len(positions), dtype=np.float32)
    given = {"age": age, "speed": age * 2, "id": np.arange(len(positions))}
    wanted = [{"attributes": {"age": 2, "id": 0}}, {"attributes": ["speed"]}, {"attributes": []}, {"attributes": "age"}]
    for options in wanted:
        with session.stream(**options) as stream:
            stream.push(positions, attributes=given)
            frame = stream.next(60)
        names = options["attributes"]
        assert set(frame.mesh.attributes) == set([names] if isinstance(names, str) else names)
        assert set(frame.attributes) == {"age", "speed", "id"}
        if isinstance(names, dict):
            assert len(np.unique(frame.mesh.attributes["age"])) <= 4
    form = frame.attributes["age"]
    assert (form.type, form.components) == ("float32", 1)
    assert 0 <= form.minimum[0] < form.maximum[0] <= 1
