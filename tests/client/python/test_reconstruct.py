"""Surfaces computed in this process: known answers, and every form that particles may have."""

import array
import warnings

import meniscus
import numpy as np
import pytest
from support.closedness import is_closed, volume
from support.particles import ball, ball_volume, particle_radius


class WithArray:
    """An object of another library that numpy can make an array of."""

    def __init__(self, values):
        self._values = values

    def __array__(self, dtype=None):
        return np.asarray(self._values, dtype)


class WithDlpackAlone:
    def __init__(self, values):
        self._values = values

    def __dlpack__(self, stream=None):
        return self._values.__dlpack__()

    def __dlpack_device__(self):
        return self._values.__dlpack_device__()


def test_a_ball_has_its_volume_and_a_closed_surface(positions, mesh):
    assert volume(mesh) == pytest.approx(ball_volume(), rel=0.1)
    assert mesh.statistics.volume == pytest.approx(volume(mesh), rel=1e-5)
    assert is_closed(mesh.triangles)
    radii = np.linalg.norm(mesh.vertices, axis=1)
    assert 0.4 < radii.min() and radii.max() < 0.6
    assert (np.einsum("ij,ij->i", mesh.normals, mesh.vertices) > 0).all()


def test_the_figures_are_those_of_the_mesh(positions, mesh):
    figures = mesh.statistics
    assert (figures.particles, figures.vertices, figures.triangles) == (
        len(positions),
        len(mesh.vertices),
        len(mesh.triangles),
    )
    counts = np.bincount(mesh.levels, minlength=4)
    assert {"crack": counts[0], **{f"level{i}": counts[i] for i in (1, 2, 3)}} == dict(figures.triangles_by_level)
    assert figures.particle_volume == pytest.approx(len(positions) * (2 * particle_radius) ** 3)
    assert (
        figures.backend in ("cpu", "cuda") and figures.threads >= (figures.backend == "cpu") and figures.peak_bytes > 0
    )
    assert figures.warnings == () and figures.total_seconds > 0 and len(figures.stage_seconds) == 8


def test_arrays_have_the_documented_forms(mesh):
    count, triangles = len(mesh.vertices), len(mesh.triangles)
    assert (mesh.vertices.shape, mesh.vertices.dtype) == ((count, 3), np.float64)
    assert (mesh.lattice.shape, mesh.lattice.dtype) == ((count, 3), np.int32)
    assert (mesh.normals.shape, mesh.normals.dtype) == ((count, 3), np.float32)
    assert (mesh.triangles.shape, mesh.triangles.dtype) == ((triangles, 3), np.uint32)
    assert (mesh.levels.shape, mesh.levels.dtype) == ((triangles,), np.uint8)
    assert (mesh.spray.shape, mesh.spray.dtype) == ((0, 3), np.float32)
    assert mesh.attributes == {}
    assert len(mesh.sha256()) == 64 and int(mesh.sha256(), 16) >= 0
    assert repr(mesh) == f"<meniscus.Mesh: {count} vertices, {triangles} triangles>"


def test_vertices_are_lattice_points(mesh):
    unit = mesh.cell_size / 2**mesh.offset_bits
    assert np.allclose(mesh.vertices, mesh.lattice * unit, rtol=0, atol=unit * 1e-6)
    assert mesh.cell_size == pytest.approx(0.5 * particle_radius)


FORMS = {
    "float64": lambda p: p.astype(np.float64),
    "fortran order": np.asfortranarray,
    "fortran order of float64": lambda p: np.asfortranarray(p.astype(np.float64)),
    "columns of a wider array": lambda p: np.hstack([p, p])[:, :3],
    "last columns of a wider array": lambda p: np.hstack([p, p])[:, 3:],
    "columns apart": lambda p: np.repeat(p, 2, axis=1)[:, ::2],
    "every second row": lambda p: np.repeat(p, 2, axis=0)[::2],
    "fields of records": lambda p: np.array(
        [(tuple(x), 1.0, i) for i, x in enumerate(p)], [("x", "f4", 3), ("mass", "f8"), ("id", "i8")]
    )["x"],
    "fields of packed records": lambda p: np.array(
        [(1, tuple(x)) for x in p], np.dtype([("kind", "u1"), ("x", "f8", 3)], align=False)
    )["x"],
    "big endian": lambda p: p.astype(">f4"),
    "big endian float64": lambda p: p.astype(">f8"),
    "backwards twice": lambda p: p[::-1].copy()[::-1],
    "columns backwards": lambda p: p[:, ::-1].copy()[:, ::-1],
    "long double": lambda p: p.astype(np.longdouble),
    "a list of lists": lambda p: p.tolist(),
    "a tuple of tuples": lambda p: tuple(map(tuple, p.tolist())),
    "a list of rows": list,
    "__array__": WithArray,
    "__array__ of a list": lambda p: WithArray(p.tolist()),
    "DLPack": lambda p: WithDlpackAlone(p.copy()),
    "DLPack of float64": lambda p: WithDlpackAlone(p.astype(np.float64)),
    "a buffer": lambda p: memoryview(p),
    "a buffer of array.array": lambda p: memoryview(array.array("f", p.ravel().tolist())).cast("B").cast("f", p.shape),
    "a masked array": lambda p: np.ma.array(p),
    "a memory map": None,
}


@pytest.mark.parametrize("form", FORMS)
def test_positions_of_every_form_give_the_same_mesh(form, positions, mesh, tmp_path):
    if "DLPack" in form and not hasattr(np, "from_dlpack"):
        pytest.skip("numpy has DLPack from 1.22 on")
    if form == "a memory map":
        np.save(tmp_path / "positions.npy", positions)
        given = np.load(tmp_path / "positions.npy", mmap_mode="r")
    else:
        given = FORMS[form](positions)
    with warnings.catch_warnings():
        warnings.simplefilter("error", meniscus.SurfaceWarning)
        assert meniscus.reconstruct(given, particle_radius).sha256() == mesh.sha256()


@pytest.mark.parametrize("dtype", [np.float16, np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint64, bool])
def test_numbers_of_every_type_are_taken_by_their_value(dtype):
    whole = (ball() * 10 + 6).astype(np.int64)  # a spacing of 1, all above 0
    given = (whole % 2 if dtype is bool else whole).astype(dtype)
    expected = meniscus.reconstruct(given.astype(np.float32), 0.5)
    assert meniscus.reconstruct(given, 0.5).sha256() == expected.sha256()
    assert len(expected.triangles) > 0


def test_float64_is_rounded_to_float32(positions, mesh):
    nudged = positions.astype(np.float64) * (1 + 1e-12)
    assert meniscus.reconstruct(nudged, particle_radius).sha256() == mesh.sha256()


@pytest.mark.parametrize("nothing", [[], (), np.empty((0, 3)), np.empty((0, 3), np.int32), np.empty(0), [[]]])
def test_no_particles_give_an_empty_mesh(nothing):
    mesh = meniscus.reconstruct(nothing, particle_radius)
    assert mesh.vertices.shape == mesh.lattice.shape == mesh.triangles.shape == mesh.normals.shape == (0, 3)
    assert mesh.levels.shape == (0,)
    assert mesh.statistics.particles == 0


def test_one_particle_is_a_drop():
    mesh = meniscus.reconstruct([[1.0, 2.0, 3.0]], particle_radius)
    assert is_closed(mesh.triangles) and len(mesh.triangles) > 0
    assert np.abs(mesh.vertices - [1, 2, 3]).max() < 2 * particle_radius


def test_given_arrays_are_left_as_they_are(positions):
    given = positions.copy()
    velocity = given * 2
    meniscus.reconstruct(given, particle_radius, attributes={"velocity": velocity})
    assert np.array_equal(given, positions) and np.array_equal(velocity, positions * 2)


def test_levels_make_particles_larger(positions):
    coarse = positions * 2
    one = meniscus.reconstruct(coarse, 2 * particle_radius, cell_size=0.5)
    level = np.ones(len(coarse), np.int64)
    other = meniscus.reconstruct(coarse, particle_radius, levels=level, cell_size=1.0)
    assert other.statistics.volume == pytest.approx(one.statistics.volume, rel=0.05)
    for form in (level.tolist(), level.astype(bool), level.astype(np.uint8)):
        again = meniscus.reconstruct(coarse, particle_radius, levels=form, cell_size=1.0)
        assert again.sha256() == other.sha256()


def test_settings_can_be_told_with_the_defaults_in_force():
    settings = meniscus.Reconstructor(0.1, iso=0.7).settings
    assert settings["particle_radius"] == 0.1 and settings["iso"] == 0.7
    assert settings["cell_size"] == 0.5 and settings["field"] == "smooth" and settings["mode"] == "adaptive"
    assert settings["criterion"] == "curvature" and settings["normals"] is True


SETTINGS = {
    "preset": [{"preset": "paper"}, {"preset": "splashsurf"}],
    "cell_size": [{"cell_size": 1.0}, {"cell_size": np.float32(1.0)}, {"cell_size": 1}, {"cell_size": "1"}],
    "iso": [{"iso": 0.5}, {"iso": np.float64(0.5)}],
    "field": [{"field": "color"}, {"field": "density"}],
    "smoothness": [{"smoothness": 7}, {"smoothness": np.int64(5)}],
    "smoothing_length": [{"field": "color", "smoothing_length": 1.5}],
    "mode": [{"mode": "uniform"}],
    "criterion": [{"criterion": "count", "field": "density"}],
    "tolerance": [{"tolerance": 1.0}],
    "count_threshold": [{"criterion": "count", "count_threshold": 20, "field": "density"}],
    "edge_points": [{"edge_points": "bisect"}],
    "bisection_steps": [{"edge_points": "bisect", "bisection_steps": 2}],
    "domain": [
        {"domain": ((-1, -1, -1), (0, 1, 1))},
        {"domain": (-1, -1, -1, 0, 1, 1)},
        {"domain": np.array([[-1, -1, -1], [0, 1, 1]])},
        {"domain": "-1 -1 -1 0 1 1"},
    ],
}


@pytest.mark.parametrize("choice", [c for choices in SETTINGS.values() for c in choices], ids=repr)
def test_every_setting_changes_the_mesh_and_is_told(choice, positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius, **choice)
    changed = reconstructor.reconstruct(positions)
    assert changed.sha256() != mesh.sha256()
    assert is_closed(changed.triangles) and len(changed.triangles) > 0
    for name in choice:
        assert name == "preset" or name in reconstructor.settings


@pytest.mark.parametrize(
    "choice",
    [
        {"preset": "smooth"},
        {"cell_size": None},
        {"threads": 1},
        {"threads": 3},
        {"backend": "cpu"},
        {"memory_limit": 1 << 30},
        {"spray": "keep"},
        {"attributes": ["velocity"][:0]},
        {"normals": True},
    ],
    ids=repr,
)
def test_what_is_the_default_or_about_the_machine_changes_nothing(choice, positions, mesh):
    assert meniscus.Reconstructor(particle_radius, **choice).reconstruct(positions).sha256() == mesh.sha256()


def test_without_normals_there_are_none(positions, mesh):
    without = meniscus.reconstruct(positions, particle_radius, normals=False)
    assert without.normals is None and without.sha256() == mesh.sha256()


def test_particles_without_company_are_spray(positions, mesh):
    lone = np.array([[3.0, 3.0, 3.0]], np.float32)
    both = np.concatenate([positions, lone])
    assert len(meniscus.reconstruct(both, particle_radius).triangles) > len(mesh.triangles)
    discarded = meniscus.reconstruct(both, particle_radius, spray="discard")
    assert discarded.sha256() == mesh.sha256() and len(discarded.spray) == 0
    listed = meniscus.reconstruct(both, particle_radius, spray="points")
    assert listed.sha256() == mesh.sha256()
    assert np.array_equal(listed.spray, lone) and not listed.spray.flags.writeable
    assert listed.statistics.spray_particles == 1


def test_a_mesh_of_the_last_frame_can_be_had_coarser(positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius)
    reconstructor.reconstruct(positions)
    coarse = [reconstructor.coarser(level) for level in (1, 2, 3)]
    assert len(coarse[0].triangles) < len(coarse[1].triangles) <= len(coarse[2].triangles)
    assert coarse[2].sha256() == mesh.sha256()
    for level, one in enumerate(coarse, 1):
        assert is_closed(one.triangles) and one.levels.max() <= level
    with pytest.raises(meniscus.InvalidInput, match="4"):
        reconstructor.coarser(4)


def test_the_reconstructor_goes_on_after_its_memory_was_released(positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius)
    first = reconstructor.reconstruct(positions)
    reconstructor.release_memory()
    assert first.sha256() == reconstructor.reconstruct(positions).sha256() == mesh.sha256()


def test_a_radius_that_does_not_fit_is_a_warning_where_it_was_called(positions):
    with pytest.warns(meniscus.SurfaceWarning, match="particle radius") as shown:
        mesh = meniscus.reconstruct(positions, particle_radius / 8)
    assert shown[0].filename == __file__
    (warning,) = mesh.statistics.warnings
    assert warning.code == "radius_too_small" and warning.value == particle_radius / 8
    assert warning.limit == pytest.approx(particle_radius, rel=0.3) and "particle radius" in warning.text
    reconstructor = meniscus.Reconstructor(particle_radius / 8)
    with pytest.warns(meniscus.SurfaceWarning, match="particle radius") as shown:
        reconstructor.reconstruct(positions)
    assert shown[0].filename == __file__
