"""The extension's own objects, which users do not see, with arrays and options that the package would never pass."""

import meniscus
import numpy as np
import pytest
from meniscus import _meniscus
from support.particles import particle_radius

good = np.zeros((4, 3), np.float32)
huge = np.lib.stride_tricks.as_strided(good, (4, 3), (1 << 40, 4), writeable=False)[:1]


def _odd_bytes():
    return np.frombuffer(b"\0" + good.tobytes(), np.uint8)[1:].view(np.float32).reshape(4, 3)


ARRAYS = {
    "None": None,
    "an object": object(),
    "a text": "text",
    "a number": 5,
    "a list": [[0.0, 0.0, 0.0]],
    "bytes": b"0123",
    "a dict": {},
    "a class": np.ndarray,
    "no dimension": np.float32(1),
    "a 0-d array": np.array(1.0, np.float32),
    "flat": np.zeros(12, np.float32),
    "two columns": np.zeros((4, 2), np.float32),
    "transposed": np.zeros((3, 4), np.float32),
    "fortran": np.asfortranarray(np.zeros((4, 3), np.float32)),
    "three dimensions": np.zeros((4, 3, 1), np.float32),
    "32 dimensions": np.zeros((1,) * 32, np.float32),
    "int64": np.zeros((4, 3), np.int64),
    "int8": np.zeros((4, 3), np.int8),
    "bool": np.zeros((4, 3), bool),
    "float16": np.zeros((4, 3), np.float16),
    "complex": np.zeros((4, 3), complex),
    "objects": np.full((4, 3), None, object),
    "texts": np.full((4, 3), "x"),
    "dates": np.zeros((4, 3), "M8[s]"),
    "records": np.zeros(4, [("x", "f4", 3), ("y", "O")]),
    "void": np.zeros((4, 3), "V4"),
    "big endian": np.zeros((4, 3), ">f4"),
    "backwards": np.zeros((4, 3), np.float32)[::-1],
    "columns backwards": np.zeros((4, 3), np.float32)[:, ::-1],
    "columns apart": np.zeros((4, 6), np.float32)[:, ::2],
    "all rows the same": np.broadcast_to(np.zeros(3, np.float32), (4, 3)),
    "one number": np.broadcast_to(np.float32(0), (4, 3)),
    "rows that overlap": np.lib.stride_tricks.as_strided(np.zeros(6, np.float32), (4, 3), (4, 4)),
    "a huge stride": huge,
    "not aligned": _odd_bytes(),
    "float64": np.zeros((4, 3)),
    "uint8 of one dimension": np.zeros(4, np.uint8),
    "uint8 that is too long": np.zeros(400, np.uint8),
    "nothing": np.empty((0, 3), np.float32),
    "nothing of another form": np.empty((0, 0), np.float32),
    "rows of nothing": np.empty((4, 0), np.float32),
}

ATTRIBUTES = [
    None,
    5,
    "text",
    {"age": good},
    [None],
    [()],
    [("age",)],
    [("age", good, good)],
    [(None, good)],
    [(5, good)],
    [("\ud800", good)],
    [("age", good), ("age", good)],
    [(f"a{i}", good) for i in range(100)],
    (x for x in ()),
]


@pytest.fixture(params=["reconstruct", "device_mesh", "push", "try_push"])
def take(request, positions):
    """A method that takes arrays, and a check that its object still works."""
    if request.param in ("reconstruct", "device_mesh"):
        raw = _meniscus.make_reconstructor({"particle-radius": "0.05", "backend": "cpu", "attribute": "all"})
        yield getattr(raw, request.param)
        # It may have taken attributes by now, which every frame with particles has to bring.
        assert len(raw.reconstruct(np.empty((0, 3), np.float32), None, [], False)[0].triangles) == 0
    else:
        session, client = (request.getfixturevalue(name) for name in ("session", "client"))
        raw = session.stream(meshes=False)._raw
        index = iter(range(10**6))
        yield lambda *arrays: getattr(raw, request.param)(*arrays, next(index), 0.0)
        raw.cancel()
        with client.session(particle_radius=particle_radius) as other, other.stream() as stream:
            stream.push(positions)
            assert stream.next(60) is not None


#: pybind11 raises RuntimeError for a part of a sequence that it cannot convert.
REFUSALS = (meniscus.Error, TypeError, ValueError, OverflowError, RuntimeError)


def survives(call, *given):
    try:
        call(*given)
    except REFUSALS:
        return False
    return True


def test_wrong_arrays_never_crash(take):
    taken = {name for name, array in ARRAYS.items() if survives(take, array, None, [])}
    assert taken <= {
        "a huge stride",
        "float64",
        "not aligned",
        "nothing",
        "all rows the same",
        "rows that overlap",
        "backwards",
    }


def test_wrong_levels_never_crash(take):
    taken = {name for name, array in ARRAYS.items() if survives(take, good, array, [])}
    assert taken <= {"None", "uint8 of one dimension"}


def test_wrong_attributes_never_crash(take):
    for array in ARRAYS.values():
        survives(take, good, None, [("age", array)])
    for arrays in ATTRIBUTES:
        survives(take, good, None, arrays)


OPTIONS = [None, 5, "text", [], {1: "a"}, {"particle-radius": 5}, {"particle-radius": None}, {None: None}, {"a": "b"}]


@pytest.mark.parametrize("options", OPTIONS, ids=repr)
def test_wrong_options_never_crash(options, server, session):
    client = _meniscus.connect(server.address, {})
    calls = [
        (_meniscus.make_reconstructor, options),
        (_meniscus.connect, server.address, options),
        (_meniscus.connect, options, {}),
        (client.open_session, options),
        (client.stream, session.id, options, None),
        (client.publish, session.id, options, None),
        (client.watch, session.id, options, None),
        (client.watch_particles, session.id, options, None),
        (client.snapshot, session.id, options),
        (client.stream, options, {}, None),
        (client.watch, session.id, {}, options),
    ]
    for call, *given in calls:
        survives(call, *given)
    assert client.info()["version"] == meniscus.__version__


CLASSES = [value for value in vars(_meniscus).values() if isinstance(value, type)]


@pytest.mark.parametrize("made", CLASSES, ids=lambda made: made.__name__)
def test_objects_cannot_be_made_past_their_makers(made):
    """Such an object would have nothing behind it, and its calls would end the process."""

    class Derived(made):
        pass

    for maker in made, Derived:
        for make in maker, maker.__new__, lambda cls: cls.__new__(cls, {}), lambda cls: object.__new__(cls):
            with pytest.raises(TypeError):
                make() if make is maker else make(maker)


def test_all_classes_are_among_them():
    assert len(CLASSES) == 16


@pytest.mark.parametrize(
    "interface",
    [
        None,
        {},
        5,
        {"shape": (4, 3), "typestr": "<f4", "data": (0, False), "version": 3},
        {"shape": (-4, 3), "typestr": "<f4", "data": (16, False), "version": 3},
        {"shape": (4, 3), "typestr": "x", "data": (16, False), "version": 3},
        {"shape": "many", "typestr": "<f4", "data": None, "version": "new"},
        {"shape": (1 << 62, 3), "typestr": "<f4", "data": (16, False), "version": 3},
        {"shape": (4, 3), "typestr": "<f4", "data": (16, False), "strides": (-12, 4), "version": 2},
        {"shape": (4, 3), "typestr": "<f4", "data": (16, False), "stream": 0, "version": 3},
    ],
    ids=repr,
)
def test_wrong_interfaces_of_a_gpu_never_crash(interface):
    raw = _meniscus.make_reconstructor({"particle-radius": str(particle_radius), "backend": "cpu", "attribute": "all"})
    for call in raw.reconstruct_from_device, raw.device_mesh_from_device:
        assert not survives(call, interface, None, [])
        assert not survives(call, interface, interface, [("age", interface)])
