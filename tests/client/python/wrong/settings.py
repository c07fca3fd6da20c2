"""Keywords of Reconstructor and Client.session: ``make(particle_radius, **settings)``."""

import meniscus
import numpy as np

from .table import wrong

Bad = meniscus.InvalidInput
inf, nan = float("inf"), float("nan")

RADII = {
    "zero": (0, "particle radius is 0", "greater than 0"),
    "negative": (-1.0, "particle radius is -1"),
    "NaN": (nan, "particle radius is -?nan", "finite"),
    "infinite": (inf, "particle radius is inf", "finite"),
    "tiny": (1e-70, "particle radius is 1e-70", "1e-60"),
    "huge": (1e70, "particle radius is 1e\\+70"),
    "huge whole": (10**400, "particle_radius"),
    "None": (None, "particle_radius"),
    "text": ("thick", "particle_radius", "thick", "number"),
    "empty text": ("", "particle_radius", "number"),
    "number with a unit": ("1m", "particle_radius", "1m"),
    "an object": (object(), "particle_radius", "object"),
    "a list": ([1.0, 2.0], "particle_radius"),
    "an empty list": ([], "particle_radius"),
    "an array": (np.array([0.1, 0.2]), "particle_radius"),
    "True": (True, "particle_radius", "true"),
    "complex": (1j, "particle_radius"),
    "a dict": ({"r": 1}, "particle_radius"),
    "a function": (len, "particle_radius"),
}

SETTINGS = {
    "unknown": ({"cellsize": 1.0}, "cellsize", "cell_size"),
    "capitals": ({"Iso": 1.0}, "Iso", "iso"),
    "of the connection": ({"token": "secret"}, "token"),
    "a text of C": ({"attribute_": 1}, "attribute_"),
    "preset unknown": ({"preset": "rough"}, "preset", "rough", "smooth", "paper", "splashsurf"),
    "preset a number": ({"preset": 1}, "preset", "smooth"),
    "cell_size zero": ({"cell_size": 0}, "cell size is 0"),
    "cell_size negative": ({"cell_size": -0.5}, "cell size is -0.5"),
    "cell_size NaN": ({"cell_size": nan}, "cell size", "finite"),
    "cell_size tiny": ({"cell_size": 1e-12}, "cell size", "1e-12"),
    "cell_size huge": ({"cell_size": 1e12}, "cell size"),
    "cell_size text": ({"cell_size": "half"}, "cell_size", "half"),
    "cell_size object": ({"cell_size": object()}, "cell_size", "object"),
    "cell_size so fine that it cannot be exact": ({"cell_size": 1e-5}, "support|cell size"),
    "iso zero": ({"iso": 0}, "iso value is 0"),
    "iso negative": ({"iso": -1}, "iso value is -1"),
    "iso NaN": ({"iso": nan}, "iso value", "finite"),
    "iso huge": ({"iso": 1e31}, "iso value", "1e\\+30"),
    "iso denormal": ({"iso": 1e-50}, "iso value", "float32"),
    "iso list": ({"iso": [0.5, 0.6]}, "iso"),
    "field unknown": ({"field": "level-set"}, "field", "level-set", "smooth", "color", "density"),
    "field list": ({"field": ["smooth"]}, "field"),
    "smoothness low": ({"smoothness": 4}, "smoothness is 4", "5 to 7"),
    "smoothness high": ({"smoothness": 8}, "smoothness is 8", "5 to 7"),
    "smoothness negative": ({"smoothness": -1}, "smoothness", "-1"),
    "smoothness fraction": ({"smoothness": 5.5}, "smoothness", "5.5", "whole number"),
    "smoothness of another field": ({"smoothness": 6, "field": "color"}, "smoothness is 6", "color"),
    "smoothing_length of another field": ({"smoothing_length": 2.0}, "smoothing length is 2", "smooth"),
    "smoothing_length zero": ({"smoothing_length": 0, "field": "color"}, "smoothing length is 0"),
    "smoothing_length huge": ({"smoothing_length": 1e7, "field": "color"}, "smoothing length"),
    "spray unknown": ({"spray": "drops"}, "spray", "drops", "keep", "discard", "points"),
    "spray of another field": ({"spray": "discard", "field": "density"}, "spray is discard", "density"),
    "mode unknown": ({"mode": "octree"}, "mode", "octree", "adaptive", "uniform"),
    "criterion unknown": ({"criterion": "guess"}, "criterion", "guess", "curvature", "count"),
    "tolerance zero": ({"tolerance": 0}, "tolerance is 0"),
    "tolerance NaN": ({"tolerance": nan}, "tolerance", "finite"),
    "tolerance of another criterion": ({"tolerance": 0.1, "criterion": "count"}, "tolerance", "criterion", "count"),
    "count_threshold zero": ({"count_threshold": 0, "criterion": "count"}, "count threshold is 0"),
    "count_threshold negative": ({"count_threshold": -2, "criterion": "count"}, "count_threshold", "-2"),
    "count_threshold of another criterion": ({"count_threshold": 3}, "count_threshold", "criterion"),
    "edge_points unknown": ({"edge_points": "newton"}, "edge_points", "newton", "interpolate", "bisect"),
    "bisection_steps zero": ({"bisection_steps": 0, "edge_points": "bisect"}, "bisection steps are 0", "1 to 7"),
    "bisection_steps many": ({"bisection_steps": 8, "edge_points": "bisect"}, "bisection steps are 8", "1 to 7"),
    "bisection_steps without": ({"bisection_steps": 3}, "bisection_steps", "edge_points"),
    "normals text": ({"normals": "no"}, "normals", "no", "true or false"),
    "normals number": ({"normals": 1}, "normals", "true or false"),
    "domain number": ({"domain": 1.0}, "domain", "6 numbers"),
    "domain of five": ({"domain": (0, 0, 0, 1, 1)}, "domain", "6 numbers"),
    "domain of seven": ({"domain": (0, 0, 0, 1, 1, 1, 1)}, "domain", "6 numbers"),
    "domain of two points": ({"domain": ((0, 0), (1, 1))}, "domain", "6 numbers"),
    "domain upside down": ({"domain": ((0, 0, 1), (1, 1, 0))}, "domain runs from 1 to 0 along z"),
    "domain flat": ({"domain": ((0, 0, 0), (1, 0, 1))}, "domain runs from 0 to 0 along y"),
    "domain NaN": ({"domain": ((0, 0, 0), (1, nan, 1))}, "domain", "finite"),
    "domain of texts": ({"domain": (("a", "b", "c"), ("d", "e", "f"))}, "domain"),
    "domain of Nones": ({"domain": (None, None)}, "domain"),
    "domain nested too deep": ({"domain": (((0,), (0,), (0,)), ((1,), (1,), (1,)))}, "domain"),
    "attributes None": ({"attributes": None}, "attribute"),
    "attributes number": ({"attributes": 5}, "attribute"),
    "attributes of numbers": ({"attributes": [1, 2]}, "attribute name 1"),
    "attributes of a colon": ({"attributes": ["age:3"]}, "'age:3'"),
    "attributes empty name": ({"attributes": [""]}, "attribute name ''"),
    "attributes of a line": ({"attributes": ["a\nb"]}, "a-z"),
    "attributes of a surrogate": ({"attributes": ["\ud800"]}, "a-z"),
    "attributes of 65": ({"attributes": ["a" * 65]}, "64"),
    "attributes twice": ({"attributes": ["age", "age"]}, "'age' twice"),
    "attributes seventeen": ({"attributes": [f"a{i}" for i in range(17)]}, "17 attributes", "16"),
    "attributes all and one": ({"attributes": ["all", "age"]}, "all alone"),
    "attributes position": ({"attributes": ["position"]}, "'position'"),
    "attributes bits": ({"attributes": {"age": 8}}, "attributes is", "names"),
}

#: Of Reconstructor alone.
MACHINE = {
    "backend unknown": ({"backend": "vulkan"}, "backend", "vulkan", "auto", "cpu", "cuda"),
    "threads negative": ({"threads": -1}, "threads", "-1"),
    "threads many": ({"threads": 100000}, "threads are 100000", "1024"),
    "threads fraction": ({"threads": 1.5}, "threads", "1.5"),
    "threads text": ({"threads": "all"}, "threads", "all"),
    "memory_limit negative": ({"memory_limit": -1}, "memory_limit", "-1"),
    "memory_limit with a unit": ({"memory_limit": "4G"}, "memory_limit", "4G"),
    "memory_limit huge": ({"memory_limit": 1 << 70}, "memory_limit"),
    "device fraction": ({"device": 0.5}, "device", "0.5"),
    "device_memory_limit negative": ({"device_memory_limit": -5}, "device_memory_limit", "-5"),
    "name of a session": ({"name": "dam"}, "name"),
}


def _make(given):
    return lambda make: make(0.05, **given)


def _radius(value):
    return lambda make: make(value)


SETTINGS_ALONE = [
    *(wrong(f"particle_radius: {name}", _radius(v), Bad, *words) for name, (v, *words) in RADII.items()),
    *(wrong(name, _make(given), Bad, *words) for name, (given, *words) in SETTINGS.items()),
    wrong("no particle_radius", lambda make: make(), TypeError, "particle_radius"),
    wrong("particle_radius twice", lambda make: make(0.05, **{"particle-radius": 0.1}), Bad, "particle-radius"),
]
MACHINES = [wrong(name, _make(given), Bad, *words) for name, (given, *words) in MACHINE.items()]
