"""Arrays of frames; ``take(positions, levels=, attributes=)`` is Reconstructor.reconstruct, or a stream's push."""

from pathlib import Path

import meniscus
import numpy as np

from .table import wrong

Bad = meniscus.InvalidInput
good = np.zeros((4, 3), np.float32)
count = len(good)


def _with(index, value, dtype=np.float32):
    changed = np.ones((count, 3), dtype)
    changed[index] = value
    return changed


def _generator():
    yield [0.0, 0.0, 0.0]


class Refuses:
    def __array__(self, dtype=None):
        raise ValueError("not today")


class LiesAboutItself:
    def __array__(self, dtype=None):
        return "no array"


class DlpackElsewhere:
    def __dlpack__(self, stream=None):
        raise AssertionError("must not be asked")

    def __dlpack_device__(self):
        return 2, 0


class OnGpu:
    __cuda_array_interface__ = {"shape": (4, 3), "typestr": "<f4", "data": (0, False), "version": 3}


SHAPE = "positions has the shape"
positions = {
    "None": (None, "positions", "object|no array"),
    "an object": (object(), "positions", "object"),
    "a text": ("water.vtk", "positions is 'water.vtk', must be an array", "read_particles"),
    "bytes": (b"water", "positions is b'water', must be an array"),
    "a path": (Path("water.vtk"), "positions is ", "read_particles"),
    "particles of a file": (meniscus.Particles(np.zeros((1, 3), np.float32), None, {}, ()), "give its .positions"),
    "a dict": ({"x": 1}, "positions", "real numbers"),
    "a set": ({1, 2, 3}, "positions", "real numbers"),
    "a generator": (_generator(), "positions", "real numbers"),
    "a function": (len, "positions", "real numbers"),
    "a module": (np, "positions", "real numbers"),
    "a number": (1.0, SHAPE, r"\(N, 3\)"),
    "one particle without its row": ([0.0, 0.0, 0.0], SHAPE, r"\(3,\)", r"\(N, 3\)"),
    "two columns": (np.zeros((4, 2)), SHAPE, r"\(4, 2\)"),
    "four columns": (np.zeros((4, 4)), SHAPE, r"\(4, 4\)"),
    "transposed": (np.zeros((3, 4)), SHAPE, r"\(3, 4\)"),
    "flat": (np.zeros(12), SHAPE, r"\(12,\)"),
    "three dimensions": (np.zeros((2, 2, 3)), SHAPE, r"\(2, 2, 3\)"),
    "no dimension": (np.array(1.0), SHAPE, r"\(\)"),
    "empty of three dimensions": (np.zeros((0, 3, 3)), SHAPE),
    "rows of different lengths": ([[0, 0, 0], [0, 0]], "positions", "no array of numbers"),
    "texts": ([["a", "b", "c"]], "positions", "<U1", "real numbers"),
    "numbers as texts": ([["1", "2", "3"]], "positions", "real numbers"),
    "objects": (np.array([[None, 1, 2]], object), "positions", "object"),
    "complex": (np.zeros((4, 3), complex), "positions", "complex128", "real numbers"),
    "dates": (np.zeros((4, 3), "M8[s]"), "positions", "datetime64"),
    "spans of time": (np.zeros((4, 3), "m8[s]"), "positions", "timedelta64"),
    "void": (np.zeros((4, 3), "V4"), "positions", "real numbers"),
    "records": (np.zeros(4, [("x", "f4"), ("y", "f4"), ("z", "f4")]), "positions", "real numbers"),
    "NaN": (_with((2, 1), np.nan), "particle 2", "y = -?nan", "finite"),
    "infinity": (_with((0, 0), np.inf), "particle 0", "x = inf", "finite"),
    "minus infinity": (_with((3, 2), -np.inf), "particle 3", "z = -inf", "finite"),
    "NaN as float64": (_with((1, 0), np.nan, np.float64), "particle 1", "x = -?nan", "finite"),
    "NaN as float16": (_with((1, 0), np.nan, np.float16), "particle 1", "finite"),
    "what float32 does not hold": (_with((1, 2), 1e300, np.float64), "particle 1", "z = "),
    "farther than cells reach": (_with((2, 0), 1e30), "particle 2", "farther from the origin"),
    "__array__ that raises": (Refuses(), "positions", "not today"),
    "__array__ that gives no array": (LiesAboutItself(), "positions"),
    "DLPack of another device": (DlpackElsewhere(), "positions", "CPU"),
    "an array on a GPU": (OnGpu(), "GPU|CUDA|cuda|device"),
}

levels = {
    "too few": (np.zeros(3, np.uint8), "levels", "3", "4 particles"),
    "too many": (np.zeros(5, np.uint8), "levels", "5", "4 particles"),
    "none": ([], "levels", "0", "4 particles"),
    "fractions": (np.zeros(4), "levels", "float64", "whole numbers"),
    "two dimensions": (np.zeros((4, 1), np.uint8), "levels", r"\(4, 1\)"),
    "a number": (1, "levels", r"\(\)"),
    "beyond the coarsest": (np.array([0, 4, 0, 0]), "particle 1", "level 4", "0 to 3"),
    "negative": (np.array([0, 0, -1, 0]), "levels", "-1", "0 to 255"),
    "beyond a byte": (np.array([0, 0, 300, 0]), "levels", "300", "255"),
    "a text": ("fine", "levels", "real numbers"),
    "texts": (["0"] * 4, "levels", "real numbers"),
    "an object": (object(), "levels", "real numbers"),
    "Nones": ([None] * 4, "levels", "real numbers"),
    "on a GPU": (OnGpu(), "levels", "GPU"),
}

ones = np.ones(count, np.float32)
attributes = {
    "a list": ([ones], "attributes is list", "by name"),
    "an array": (ones, "attributes is ndarray", "by name"),
    "a text": ("velocity", "attributes is str", "by name"),
    "pairs": ([("velocity", ones)], "attributes is list"),
    "a number as a name": ({1: ones}, "name of an attribute is 1", "a-z"),
    "None as a name": ({None: ones}, "name of an attribute is None"),
    "bytes as a name": ({b"age": ones}, "name of an attribute is b'age'"),
    "an empty name": ({"": ones}, "1 to 64"),
    "capitals": ({"Velocity": ones}, "'Velocity'", "a-z"),
    "a space": ({"my age": ones}, "'my age'", "a-z"),
    "an umlaut": ({"größe": ones}, "größe", "a-z"),
    "a surrogate": ({"\ud800": ones}, "ud800", "a-z"),
    "a zero byte": ({"a\0b": ones}, "a-z"),
    "a name of 65": ({"a" * 65: ones}, "64"),
    "a name of a million": ({"a" * 1000000: ones}, "64"),
    "position": ({"position": ones}, "'position'"),
    "level": ({"level": ones}, "'level'"),
    "None": ({"age": None}, "'age'", "real numbers"),
    "texts": ({"age": ["old"] * 4}, "'age'", "real numbers"),
    "an object": ({"age": object()}, "'age'", "real numbers"),
    "a number": ({"age": 1.0}, "'age'", r"\(\)"),
    "complex": ({"age": np.zeros(4, complex)}, "'age'", "complex128"),
    "dates": ({"age": np.zeros(4, "M8[s]")}, "'age'", "datetime64"),
    "three dimensions": ({"age": np.zeros((4, 3, 1))}, "'age'", r"\(4, 3, 1\)"),
    "two components": ({"uv": np.zeros((4, 2), np.float32)}, "'uv'", "1, 3 or 4"),
    "five components": ({"five": np.zeros((4, 5), np.float32)}, "'five'", "1, 3 or 4"),
    "no component": ({"none": np.zeros((4, 0), np.float32)}, "'none'"),
    "ids of three components": ({"ids": np.zeros((4, 3), np.int32)}, "'ids'", "int32"),
    "too few": ({"age": np.zeros(3, np.float32)}, "'age'", "4 particles"),
    "too many": ({"age": np.zeros(5, np.float32)}, "'age'", "4 particles"),
    "none at all": ({"age": []}, "'age'"),
    "NaN": ({"age": np.array([1, 1, np.nan, 1], np.float32)}, "particle 2", "'age'", "finite"),
    "infinity": ({"age": np.array([1, np.inf, 1, 1])}, "particle 1", "'age'", "finite"),
    "what float32 does not hold": ({"age": np.array([1, 1e300, 1, 1])}, "particle 1", "'age'", "finite"),
    "ids beyond int32": ({"id": np.array([0, 1, 2, 2**40])}, "'id'", str(2**40)),
    "ids beyond uint32": ({"id": np.array([0, 1, 2, 2**40], np.uint64)}, "'id'", str(2**40)),
    "ids below int32": ({"id": np.array([0, 1, 2, -(2**40)])}, "'id'", str(2**40)),
    "rows of different lengths": ({"age": [[1], [1, 2], [1], [1]]}, "'age'", "no array of numbers"),
    "on a GPU": ({"age": OnGpu()}, "'age'", "GPU"),
}


def _frame(**given):
    return lambda take: take(**{"positions": good, **given})


FRAMES = [
    *(wrong(f"positions: {name}", _frame(positions=v), Bad, *words) for name, (v, *words) in positions.items()),
    *(wrong(f"levels: {name}", _frame(levels=v), Bad, *words) for name, (v, *words) in levels.items()),
    *(wrong(f"attributes: {name}", _frame(attributes=v), Bad, *words) for name, (v, *words) in attributes.items()),
    wrong("no positions at all", lambda take: take(), TypeError, "positions"),
    wrong("levels by place", lambda take: take(good, None), TypeError, "positional|particle_radius"),
    wrong(
        "an unknown keyword", lambda take: take(good, velocities=good), (TypeError, meniscus.InvalidInput), "velocities"
    ),
    wrong("more than memory has", _frame(positions=np.broadcast_to(good[:1], (1 << 42, 3))), MemoryError, "."),
]
