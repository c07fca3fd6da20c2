"""Surfaces on disk, by what they were made of: the least recently used go when there are too many bytes of them."""

import hashlib
import json
import os
import tempfile
import threading
import zipfile

import numpy as np

from .surface import Surface

#: Part of every key: a change of the files' layout makes the older ones unknown.
LAYOUT = 1
_EXTENSION = ".surface.npz"
#: A file that is being written for longer than this was left by a process that was killed.
_ABANDONED_SECONDS = 3600


def key_of(path, settings, version):
    """The key of a file's surface: the file's name, size and time of change, and what makes the surface of it.

    settings: what json can write. Raises OSError for a file that is not there.
    """
    stat = os.stat(path)
    parts = [LAYOUT, version, os.path.abspath(path), stat.st_size, stat.st_mtime_ns, settings]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


class SurfaceCache:
    """Files in one folder, which several processes may use at once. A damaged file counts as one that is not there."""

    def __init__(self, folder, max_bytes):
        self.folder = folder
        self.max_bytes = max_bytes
        self._lock = threading.Lock()
        self._bytes = None  # of all files, as far as this process knows; None: not counted yet

    def __contains__(self, key):
        return os.path.exists(self._path(key))

    def get(self, key):
        """The surface, or None."""
        path = self._path(key)
        try:
            with np.load(path, allow_pickle=False) as arrays:
                surface = _unpacked(arrays)
            os.utime(path)  # used just now
            return surface
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, zipfile.BadZipFile, EOFError):
            self._remove(path)
            return None

    def put(self, key, surface):
        """Raises OSError where nothing can be written. A surface that alone is too large is not kept."""
        os.makedirs(self.folder, exist_ok=True)
        descriptor, path = tempfile.mkstemp(suffix=".part", dir=self.folder)
        try:
            with os.fdopen(descriptor, "wb") as file:
                np.savez(file, **_packed(surface))
            size = os.path.getsize(path)
            if size > self.max_bytes:
                os.remove(path)
                return
            os.replace(path, self._path(key))
        except BaseException:
            self._remove(path)
            raise
        with self._lock:
            self._bytes = None if self._bytes is None else self._bytes + size
            if self._bytes is None or self._bytes > self.max_bytes:
                self._trim()

    def clear(self):
        """Removes all surfaces. Gives the bytes that this has freed."""
        with self._lock:
            freed = sum(size for _, size, path in self._files() if self._remove(path))
            self._bytes = 0
        return freed

    def _path(self, key):
        return os.path.join(self.folder, key + _EXTENSION)

    def _files(self):
        """(time of use, bytes, path) of each, the least recently used first."""
        listed = []
        try:
            entries = list(os.scandir(self.folder))
        except OSError:
            return []
        for entry in entries:
            try:
                stat = entry.stat()
            except OSError:
                continue  # another process has removed it
            if entry.name.endswith(_EXTENSION):
                listed.append((stat.st_mtime_ns, stat.st_size, entry.path))
            elif entry.name.endswith(".part") and stat.st_mtime < _newest(entries) - _ABANDONED_SECONDS:
                self._remove(entry.path)
        return sorted(listed)

    def _trim(self):
        """Down to nine tenths of the limit, so that not every further surface looks at the folder again."""
        listed = self._files()
        total = sum(size for _, size, _ in listed)
        wanted = self.max_bytes if total <= self.max_bytes else self.max_bytes * 9 // 10
        for _, size, path in listed[:-1]:  # never the newest
            if total <= wanted:
                break
            self._remove(path)
            total -= size
        self._bytes = total

    @staticmethod
    def _remove(path):
        try:
            os.remove(path)
            return True
        except OSError:
            return False


def _newest(entries):
    times = []
    for entry in entries:
        try:
            times.append(entry.stat().st_mtime)
        except OSError:
            pass
    return max(times, default=0.0)


def _packed(surface):
    fields = {
        "warnings": surface.warnings,
        "fitting_radius": surface.fitting_radius,
        "particles": surface.particles,
        "names": list(surface.attributes),  # which a name of an array could not hold for all file systems of a zip
    }
    arrays = {"vertices": surface.vertices, "triangles": surface.triangles, "told": np.array(json.dumps(fields))}
    if surface.normals is not None:
        arrays["normals"] = surface.normals
    for place, values in enumerate(surface.attributes.values()):
        arrays[f"attribute_{place}"] = values
    return arrays


def _unpacked(arrays):
    fields = json.loads(str(arrays["told"]))
    return Surface(
        arrays["vertices"],
        arrays["triangles"],
        arrays["normals"] if "normals" in arrays else None,
        {name: arrays[f"attribute_{place}"] for place, name in enumerate(fields["names"])},
        tuple(fields["warnings"]),
        fields["fitting_radius"],
        fields["particles"],
    )
