"""Surfaces on disk."""

import os

import numpy as np
import pytest

from meniscus_blender.cache import SurfaceCache, key_of
from meniscus_blender.surface import Surface


def surface(seed=0, vertices=100, **more):
    random = np.random.default_rng(seed)
    return Surface(
        random.random((vertices, 3), np.float32),
        random.integers(0, vertices, (2 * vertices, 3)).astype(np.int32),
        random.random((vertices, 3), np.float32),
        {"velocity": random.random((vertices, 3), np.float32), "id": np.arange(vertices, dtype=np.uint32)},
        **more,
    )


def test_what_is_put_comes_back(tmp_path):
    cache = SurfaceCache(tmp_path / "new", 1 << 20)
    put = surface(warnings=("a radius of 1 m \u2026 is odd",), fitting_radius=0.5, particles=7)
    cache.put("k", put)
    got = cache.get("k")
    assert "k" in cache
    assert np.array_equal(got.vertices, put.vertices) and np.array_equal(got.triangles, put.triangles)
    assert np.array_equal(got.normals, put.normals)
    assert list(got.attributes) == ["velocity", "id"] and got.attributes["id"].dtype == np.uint32
    assert np.array_equal(got.attributes["velocity"], put.attributes["velocity"])
    assert (got.warnings, got.fitting_radius, got.particles) == (put.warnings, 0.5, 7)


def test_an_empty_surface_comes_back(tmp_path):
    cache = SurfaceCache(tmp_path, 1 << 20)
    cache.put("k", Surface(np.empty((0, 3), np.float32), np.empty((0, 3), np.int32)))
    got = cache.get("k")
    assert got.vertices.shape == got.triangles.shape == (0, 3) and got.normals is None and got.attributes == {}


def test_what_was_never_put_is_not_there(tmp_path):
    assert SurfaceCache(tmp_path, 1 << 20).get("k") is None
    assert SurfaceCache(tmp_path / "nowhere", 1 << 20).get("k") is None


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 no archive", None])
def test_a_damaged_file_is_not_there_and_goes(tmp_path, damage):
    cache = SurfaceCache(tmp_path, 1 << 20)
    cache.put("k", surface())
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    if damage is None:
        damage = whole[:1000] + bytes([whole[1000] ^ 1]) + whole[1001:]  # one bit of an array
    path.write_bytes(damage)
    assert cache.get("k") is None
    assert not path.exists()


def test_the_bytes_are_bounded_and_the_least_recently_used_go(tmp_path):
    cache = SurfaceCache(tmp_path, 10**9)
    cache.put("size", surface())
    size = sum(path.stat().st_size for path in tmp_path.iterdir())
    cache.clear()
    cache = SurfaceCache(tmp_path, 5 * size + size // 2)
    for number in range(5):
        cache.put(f"k{number}", surface(number))
        os.utime(tmp_path / f"k{number}.surface.npz", ns=(number * 10**9, number * 10**9))
    assert cache.get("k0") is not None  # used just now
    cache.put("k5", surface(5))
    assert "k0" in cache and "k5" in cache and "k1" not in cache and "k2" not in cache
    for number in range(6, 30):
        cache.put(f"k{number}", surface(number))
        assert sum(path.stat().st_size for path in tmp_path.iterdir()) <= cache.max_bytes
        assert f"k{number}" in cache


def test_what_another_process_has_written_counts(tmp_path):
    one = SurfaceCache(tmp_path, 10**9)
    one.put("size", surface())
    size = sum(path.stat().st_size for path in tmp_path.iterdir())
    for number in range(10):
        one.put(f"k{number}", surface(number))
    another = SurfaceCache(tmp_path, 3 * size)
    another.put("new", surface(99))
    assert sum(path.stat().st_size for path in tmp_path.iterdir()) <= 3 * size and "new" in another


def test_a_surface_larger_than_the_limit_is_not_kept(tmp_path):
    cache = SurfaceCache(tmp_path, 100)
    cache.put("k", surface())
    assert "k" not in cache and list(tmp_path.iterdir()) == []


def test_clearing_leaves_what_is_not_the_caches(tmp_path):
    cache = SurfaceCache(tmp_path, 1 << 20)
    (tmp_path / "holiday.jpg").write_text("mine")
    cache.put("k", surface())
    assert cache.clear() > 1000
    assert [path.name for path in tmp_path.iterdir()] == ["holiday.jpg"]


def test_a_folder_that_cannot_be_written_is_an_error(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OSError):
        SurfaceCache(tmp_path / "file" / "folder", 1 << 20).put("k", surface())


def test_a_key_is_of_the_file_as_it_is_and_of_the_settings(tmp_path):
    path = tmp_path / "a.vtk"
    path.write_text("x")
    os.utime(path, ns=(10**9, 10**9))
    keys = {key_of(path, {"cell_size": 0.5}, "1")}
    assert key_of(path, {"cell_size": 0.5}, "1") in keys
    keys.add(key_of(path, {"cell_size": 0.6}, "1"))
    keys.add(key_of(path, {"cell_size": 0.5}, "2"))
    os.utime(path, ns=(10**9, 10**9 + 1))
    keys.add(key_of(path, {"cell_size": 0.5}, "1"))
    path.write_text("xy")
    os.utime(path, ns=(10**9, 10**9))
    keys.add(key_of(path, {"cell_size": 0.5}, "1"))
    assert len(keys) == 5
    with pytest.raises(OSError):
        key_of(tmp_path / "b.vtk", {}, "1")
