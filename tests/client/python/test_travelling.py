"""Meshes that leave their process, or are copied."""

import copy
import pickle

import meniscus
import numpy as np
import pytest
from meniscus import _meniscus
from support.particles import particle_radius
from support.scripts import run_script

FORMS = {
    "of the defaults": {},
    "without normals": {"normals": False},
    "with spray": {"spray": "points"},
    "of the paper": {"preset": "paper"},
}


@pytest.fixture
def carried(positions):
    velocity = positions * 3
    numbers = np.arange(len(positions))
    return {"velocity": velocity, "id": numbers.astype(np.int32), "kind": (numbers % 3).astype(np.uint8)}


@pytest.fixture(params=FORMS, ids=FORMS)
def made(request, positions, carried):
    return meniscus.reconstruct(positions, particle_radius, attributes=carried, **FORMS[request.param])


def arrays_of(mesh):
    named = {name: getattr(mesh, name) for name in ("vertices", "lattice", "triangles", "levels", "spray", "normals")}
    return {**named, **mesh.attributes}


def check_same(found, expected):
    assert found.sha256() == expected.sha256()
    assert (found.cell_size, found.offset_bits) == (expected.cell_size, expected.offset_bits)
    assert found.statistics == expected.statistics
    assert list(found.attributes) == list(expected.attributes)
    for name, array in arrays_of(expected).items():
        same = arrays_of(found)[name]
        if array is None:
            assert same is None, name
        else:
            assert same.dtype == array.dtype and same.tobytes() == array.tobytes() and same.shape == array.shape, name


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_a_pickled_mesh_is_the_same_to_the_bit(made, protocol):
    check_same(pickle.loads(pickle.dumps(made, protocol)), made)


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy])
def test_a_copied_mesh_is_the_same_and_shares_its_memory(made, copied):
    found = copied(made)
    check_same(found, made)
    assert found is not made and np.shares_memory(found.triangles, made.triangles)


def test_a_received_mesh_travels(session, positions, carried):
    with session.stream() as stream:
        stream.push(positions, attributes=carried)
        made = stream.next(60).mesh
    check_same(pickle.loads(pickle.dumps(made)), made)


def test_an_empty_mesh_travels():
    for normals in True, False:
        made = meniscus.reconstruct(np.empty((0, 3)), particle_radius, normals=normals)
        check_same(pickle.loads(pickle.dumps(made)), made)


@pytest.mark.parametrize("extension", meniscus.mesh_extensions())
def test_a_mesh_that_has_travelled_is_saved_as_before(extension, made, tmp_path):
    made.save(tmp_path / f"before{extension}")
    pickle.loads(pickle.dumps(made)).save(tmp_path / f"after{extension}")
    # At the end of .bricks are the frame's figures, with the time of the encoding.
    end = -200 if extension == ".bricks" else None
    before = (tmp_path / f"before{extension}").read_bytes()[:end]
    assert len(before) > 1000 and (tmp_path / f"after{extension}").read_bytes()[:end] == before


def test_a_mesh_comes_from_a_spawned_process_as_it_was_made_there(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        """
import concurrent.futures, multiprocessing
import numpy as np, meniscus

positions = np.random.default_rng(3).random((500, 3))

def surface(radius):
    return meniscus.reconstruct(positions, radius, attributes={"place": positions})

if __name__ == "__main__":
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        for radius, mesh in zip((0.05, 0.06), pool.map(surface, (0.05, 0.06))):
            here = surface(radius)
            assert mesh.sha256() == here.sha256() and mesh.statistics.triangles == len(here.triangles)
            assert np.array_equal(mesh.attributes["place"], here.attributes["place"])
    print("done")
"""
    )
    code, out, err = run_script("import runpy, sys; runpy.run_path(sys.argv[1], run_name='__main__')", program)
    assert (code, out, err) == (0, "done\n", "")


def test_what_comes_of_sessions_and_files_travels(client, session, positions, tmp_path):
    np.savez(tmp_path / "p.npz", positions=positions, velocity=positions)
    for value in client.info(), client.sessions(), session.info():
        assert pickle.loads(pickle.dumps(value)) == value
    particles = pickle.loads(pickle.dumps(meniscus.read_particles(tmp_path / "p.npz")))
    assert np.array_equal(particles.attributes["velocity"], positions)


def state_of(positions):
    return meniscus.reconstruct(positions, particle_radius, attributes={"v": positions})._raw.state()


BAD = {
    "nothing": lambda s: s.clear(),
    "no triangles": lambda s: s.pop("triangles"),
    "a corner that is no vertex": lambda s: s.update(triangles=s["triangles"] + np.uint32(len(s["lattice"]))),
    "fewer vertices": lambda s: s.update(lattice=s["lattice"][:-1].copy()),
    "vertices of another type": lambda s: s.update(lattice=s["lattice"].astype(np.int64)),
    "vertices of two numbers": lambda s: s.update(lattice=s["lattice"][:, :2].copy()),
    "vertices in columns": lambda s: s.update(lattice=np.asfortranarray(s["lattice"])),
    "fewer normals": lambda s: s.update(normals=s["normals"][:-1].copy()),
    "a level that is too long": lambda s: s.update(levels=((0, 1 << 31),) * 4),
    "levels that begin behind the end": lambda s: s.update(levels=((1 << 31, 0),) * 4),
    "three levels": lambda s: s.update(levels=s["levels"][:3]),
    "a brick of other triangles": lambda s: s.update(bricks=s["bricks"] | np.int32(1 << 30)),
    "an attribute of fewer": lambda s: s.update(attributes=[("v", s["attributes"][0][1][:-1].copy())]),
    "an attribute of float64": lambda s: s.update(attributes=[("v", s["attributes"][0][1].astype(float))]),
    "an attribute that is none": lambda s: s.update(attributes=[("v", None)]),
    "a cell size below zero": lambda s: s.update(cell_size=-0.5),
    "a cell size that is no number": lambda s: s.update(cell_size=float("nan")),
    "offsets of many bits": lambda s: s.update(offset_bits=40),
    "other figures": lambda s: s.update(figures=b"\xff\xff\xff"),
}


@pytest.mark.parametrize("damage", BAD)
def test_a_damaged_pickle_is_refused_and_never_crashes(damage, positions):
    state = state_of(positions)
    BAD[damage](state)
    with pytest.raises(meniscus.InvalidInput, match="the pickled mesh is damaged: "):
        _meniscus.restore_mesh(state)
