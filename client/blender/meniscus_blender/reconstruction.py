"""The surface of a file of particles: from the cache, or reconstructed and then kept there."""

import threading
import warnings
from dataclasses import dataclass
from typing import Any, Optional, Tuple

from . import cache, package, sequence
from .surface import surface_of


@dataclass(frozen=True)
class Request:
    """A frame of a sequence, and what is to be made of it."""

    pattern: str  #: absolute, with {} or without
    number: Optional[int]  #: of the file; anything where the pattern has no {}
    particle_radius: float  #: in the units of the file
    settings: Tuple[Tuple[str, Any], ...] = ()  #: the other keywords of meniscus.Reconstructor
    attributes: Tuple[str, ...] = ("all",)  #: arrays of the file that the mesh gets; "all" of them
    normals: bool = False  #: whether the surface gets the field's normals


@dataclass(frozen=True)
class Made:
    """A surface and its identity: that of the file as it was then, and of the request."""

    key: str
    surface: Any


class Reconstruction:
    """Makes surfaces; several threads may ask at once, and take turns. Buffers are kept from frame to frame."""

    def __init__(self, surfaces: cache.SurfaceCache):
        self.cache = surfaces
        self.cache_error = ""  #: why the last surface could not be kept; the surface itself is not affected
        self._lock = threading.Lock()
        self._reconstructor = None
        self._made_for = None

    def make(self, request):
        """Raises SequenceError for a file that is not there, PackageMissing, meniscus.Error for what is wrong."""
        library = package.meniscus()
        path, key = self._located(request, library)
        surface = self.cache.get(key)
        if surface is None:
            surface = self._reconstruct(library, path, request)
            self._keep(key, surface)
        return Made(key, surface)

    def prepare(self, request):
        """Makes a surface as make() does, but only puts it into the cache."""
        library = package.meniscus()
        path, key = self._located(request, library)
        if key not in self.cache:
            self._keep(key, self._reconstruct(library, path, request))

    def release(self):
        """Gives the buffers back."""
        with self._lock:
            self._reconstructor = self._made_for = None

    def _located(self, request, library):
        path = sequence.path_of(request.pattern, request.number)
        ingredients = [request.particle_radius, sorted(request.settings), sorted(request.attributes), request.normals]
        try:
            return path, cache.key_of(path, ingredients, library.__version__)
        except OSError as error:
            raise sequence.SequenceError(f"{path}: {error.strerror}") from None

    def _keep(self, key, surface):
        try:
            self.cache.put(key, surface)
            self.cache_error = ""
        except OSError as error:
            self.cache_error = f"the cache cannot be written: {error}"

    def _reconstruct(self, library, path, request):
        particles = library.read_particles(path)
        arrays = _chosen(library, path, particles, request.attributes)
        # Attributes are fixed by a reconstructor's first frame: files with other arrays get one of their own.
        wanted = (request.particle_radius, request.settings, request.normals, _forms(arrays))
        with self._lock, warnings.catch_warnings():
            warnings.simplefilter("ignore", library.SurfaceWarning)  # they are in the statistics, too
            if self._made_for != wanted:
                self._made_for = None
                self._reconstructor = library.Reconstructor(
                    request.particle_radius,
                    attributes=tuple(arrays),
                    normals=request.normals,
                    **dict(request.settings),
                )
                self._made_for = wanted
            mesh = self._reconstructor.reconstruct(particles.positions, levels=particles.levels, attributes=arrays)
        return surface_of(mesh, mesh.statistics, request.normals)


def _chosen(library, path, particles, names):
    if "all" in names:
        return dict(particles.attributes)
    absent = [name for name in names if name not in particles.attributes]
    if absent:
        there = ", ".join(particles.attributes) or "none"
        raise library.InvalidInput(f"{path}: there is no attribute {absent[0]!r}; there are: {there}")
    return {name: particles.attributes[name] for name in names}


def _forms(arrays):
    return tuple((name, values.dtype.str, values.shape[1:]) for name, values in arrays.items())
