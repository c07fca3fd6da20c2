"""From a file to its surface, with a package that is played."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from meniscus_blender import package
from meniscus_blender.cache import SurfaceCache
from meniscus_blender.reconstruction import Reconstruction, Request
from meniscus_blender.sequence import SequenceError


class Library:
    """Counts what is made. A file has as many particles as bytes."""

    __version__ = "1"
    SurfaceWarning = UserWarning

    class InvalidInput(ValueError):
        pass

    def __init__(self):
        self.reconstructors = []
        self.frames = 0

    def read_particles(self, path):
        count = len(open(path, "rb").read())
        if count == 13:
            raise self.InvalidInput(f"{path}: byte 1: no particles")
        attributes = {"velocity": np.ones((count, 3), np.float32), "id": np.arange(count, dtype=np.uint32)}
        return SimpleNamespace(positions=np.zeros((count, 3)), levels=None, attributes=attributes)

    def Reconstructor(self, particle_radius, **options):
        self.reconstructors.append((particle_radius, options))
        return self

    def reconstruct(self, positions, levels, attributes):
        self.frames += 1
        warning = SimpleNamespace(code="radius_too_small", limit=0.5, text="about 0.5 fits")
        return SimpleNamespace(
            vertices=np.asarray(positions, np.float64),
            triangles=np.zeros((1, 3), np.uint32),
            normals=np.zeros((len(positions), 3), np.float32),
            attributes=attributes,
            statistics=SimpleNamespace(warnings=(warning,), particles=len(positions)),
        )


@pytest.fixture
def library(monkeypatch):
    library = Library()
    monkeypatch.setattr(package, "meniscus", lambda: library)
    return library


@pytest.fixture
def reconstruction(tmp_path):
    return Reconstruction(SurfaceCache(tmp_path / "cache", 1 << 20))


@pytest.fixture
def request_(tmp_path):
    for number in (1, 2, 3):
        (tmp_path / f"f{number}.npy").write_bytes(b"x" * (10 + number))
    return Request(str(tmp_path / "f{}.npy"), 1, 0.025, (("cell_size", 0.5),))


def test_a_surface_is_made_once(library, reconstruction, request_):
    made = reconstruction.make(request_)
    again = reconstruction.make(request_)
    assert library.frames == 1 and made.key == again.key
    for surface in (made.surface, again.surface):
        assert len(surface.vertices) == surface.particles == 11 and surface.normals is None
        assert (surface.warnings, surface.fitting_radius) == (("about 0.5 fits",), 0.5)
        assert list(surface.attributes) == ["velocity", "id"]


def test_other_settings_make_another_surface(library, reconstruction, request_):
    others = [
        replace(request_, number=2),
        replace(request_, particle_radius=0.03),
        replace(request_, settings=(("cell_size", 0.6),)),
        replace(request_, attributes=("id",)),
        replace(request_, normals=True),
    ]
    keys = {reconstruction.make(request).key for request in [request_, *others]}
    assert len(keys) == library.frames == 6


def test_a_file_that_was_written_again_makes_another_surface(library, reconstruction, request_, tmp_path):
    before = reconstruction.make(request_)
    (tmp_path / "f1.npy").write_bytes(b"x" * 99)
    assert len(reconstruction.make(request_).surface.vertices) == 99 and reconstruction.make(request_).key != before.key


def test_buffers_are_kept_from_frame_to_frame(library, reconstruction, request_):
    reconstruction.make(request_)
    reconstruction.make(replace(request_, number=2))
    assert len(library.reconstructors) == 1
    assert library.reconstructors[0] == (
        0.025,
        {"attributes": ("velocity", "id"), "normals": False, "cell_size": 0.5},
    )


def test_filling_makes_nothing_that_is_there(library, reconstruction, request_):
    for _ in range(2):
        reconstruction.prepare(request_)
    assert library.frames == 1
    reconstruction.make(request_)
    assert library.frames == 1


def test_only_the_named_attributes_come_along(library, reconstruction, request_):
    assert list(reconstruction.make(replace(request_, attributes=("id",))).surface.attributes) == ["id"]
    assert reconstruction.make(replace(request_, attributes=())).surface.attributes == {}
    with pytest.raises(Library.InvalidInput, match="f1.npy: there is no attribute 'age'; there are: velocity, id"):
        reconstruction.make(replace(request_, attributes=("age",)))


def test_a_missing_file_and_a_wrong_one_are_named(library, reconstruction, request_):
    with pytest.raises(SequenceError, match="no file with the number 4; there are 3, from 1 to 3"):
        reconstruction.make(replace(request_, number=4))
    with pytest.raises(Library.InvalidInput, match="f3.npy: byte 1"):
        reconstruction.make(replace(request_, number=3))
    assert reconstruction.make(request_).surface.particles == 11


def test_a_cache_that_cannot_be_written_costs_no_surface(library, request_, tmp_path):
    (tmp_path / "cache").touch()
    reconstruction = Reconstruction(SurfaceCache(tmp_path / "cache", 1 << 20))
    assert reconstruction.make(request_).surface.particles == 11
    assert "the cache cannot be written" in reconstruction.cache_error


def test_without_the_package_the_error_is_its_own(monkeypatch, reconstruction, request_):
    def missing():
        raise package.PackageMissing("needs a wheel")

    monkeypatch.setattr(package, "meniscus", missing)
    with pytest.raises(package.PackageMissing, match="needs a wheel"):
        reconstruction.make(request_)
