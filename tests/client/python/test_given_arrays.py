"""Arrays with a mask, and arrays of devices, which are played: this machine has none."""

import meniscus
import numpy as np
import pytest
from support.particles import particle_radius


def test_masked_particles_are_refused_with_what_to_do(positions, mesh, session):
    masked = np.ma.masked_greater(positions, 0.2)
    with session.stream() as stream:
        for take in lambda x: meniscus.reconstruct(x, particle_radius), stream.push:
            with pytest.raises(meniscus.InvalidInput, match=r"positions has \d+ masked values, must have none: leave"):
                take(masked)
    # What the message advises.
    kept = masked[~np.ma.getmaskarray(masked).any(axis=1)].data
    expected = meniscus.reconstruct(positions[(positions <= 0.2).all(axis=1)], particle_radius)
    assert meniscus.reconstruct(kept, particle_radius).sha256() == expected.sha256()
    ages = np.ma.masked_array(np.ones(len(positions)), mask=np.arange(len(positions)) == 7)
    with pytest.raises(meniscus.InvalidInput, match="the attribute 'age' has 1 masked values"):
        meniscus.reconstruct(positions, particle_radius, attributes={"age": ages})


def test_an_array_whose_mask_covers_nothing_is_as_good_as_any(positions, mesh):
    for mask in False, np.zeros_like(positions, bool):
        plain = np.ma.masked_array(positions, mask=mask)
        assert meniscus.reconstruct(plain, particle_radius).sha256() == mesh.sha256()


class OnDevice:
    """An array on a device, as far as it tells; what is asked of it is counted."""

    def __init__(self, array):
        self._array = array
        self.asked = []
        self.__cuda_array_interface__ = {
            "shape": array.shape,
            "typestr": array.dtype.str,
            "data": (1, False),
            "version": 3,
        }

    def __array__(self, *_, **__):
        raise TypeError("an implicit conversion to numpy is not allowed")


class OfCuPy(OnDevice):
    def get(self):
        self.asked.append("get")
        return self._array


class OfNumba(OnDevice):
    def copy_to_host(self):
        self.asked.append("copy_to_host")
        return self._array


class OfWarp(OnDevice):
    def numpy(self):
        self.asked.append("numpy")
        return self._array


class OfPyTorch(OnDevice):
    def detach(self):
        self.asked.append("detach")
        return self

    def cpu(self):
        self.asked.append("cpu")
        return self._array


class OfCuDF(OnDevice):
    def get(self, key):
        raise AssertionError("this is the value of a key")

    def to_numpy(self):
        self.asked.append("to_numpy")
        return self._array


class OfJAX(OnDevice):
    def __array__(self, *_, **__):
        self.asked.append("__array__")
        return self._array


class WithDLPack(OnDevice):
    def __dlpack_device__(self):
        return 2, 0  # CUDA

    def __dlpack__(self, *, stream=None, dl_device=None, copy=None):
        if dl_device != (1, 0) or not copy:
            raise BufferError("it lies on the GPU")
        self.asked.append("dlpack")
        return self._array.__dlpack__()


class WithOldDLPack(OfCuPy):
    def __dlpack_device__(self):
        return 2, 0

    def __dlpack__(self, stream=None):
        raise AssertionError("what lies on the GPU cannot be read")


KINDS = {
    OfCuPy: ["get"],
    OfNumba: ["copy_to_host"],
    OfWarp: ["numpy"],
    OfPyTorch: ["detach", "cpu"],
    OfCuDF: ["to_numpy"],
    OfJAX: ["__array__"],
    WithDLPack: ["dlpack"],
    WithOldDLPack: ["get"],
}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_a_stream_takes_what_lies_on_a_device(kind, session, positions, mesh):
    ids = np.arange(len(positions), dtype=np.int32)
    with session.stream(attribute_bits=0, normal_bits=0) as stream:
        for push in stream.push, stream.try_push:
            given = [kind(np.array(values)) for values in (positions, np.zeros(len(positions), np.uint8), ids)]
            push(given[0], levels=given[1], attributes={"id": given[2]})
            frame = stream.next(60)
            assert all(one.asked == KINDS[kind] for one in given)
            assert frame.mesh.sha256() == mesh.sha256() and set(frame.mesh.attributes["id"]) <= set(ids)


def test_a_device_that_is_told_by_dlpack_alone_is_copied_down_too(session, positions, mesh):
    given = WithDLPack(np.array(positions))
    del given.__cuda_array_interface__
    with session.stream() as stream:
        stream.push(given)
        assert stream.next(60).mesh.sha256() == mesh.sha256()


def test_what_has_no_way_down_is_named(session, positions):
    with session.stream() as stream:
        with pytest.raises(meniscus.InvalidInput, match="positions lies on a GPU, and OnDevice offers no copy"):
            stream.push(OnDevice(np.array(positions)))
        with pytest.raises(meniscus.InvalidInput, match="the attribute 'age' lies on a GPU"):
            stream.push(positions, attributes={"age": OnDevice(np.array(positions))})
