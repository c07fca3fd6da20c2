"""Particles as the library takes them: numpy arrays of few forms, made of whatever a simulator has."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Optional

import numpy as np

from .errors import InvalidInput
from .named import array_name

if TYPE_CHECKING:  # from numpy 1.20 on
    Array = np.ndarray[Any, np.dtype[Any]]


class Frame(NamedTuple):
    """The arrays of one frame; not copied where their form allows that."""

    positions: Array  #: (N, 3), float32 or float64, the three numbers of a particle next to each other
    levels: Optional[Array]  #: (N,), uint8
    arrays: list[tuple[str, Array]]  #: by name: (N,) or (N, k), float32, uint8, int32 or uint32, C order


def frame(positions: Any, levels: Any = None, attributes: Optional[Mapping[str, Any]] = None) -> Frame:
    """Raises InvalidInput for what is no array, or of a wrong form or type; values are looked at in C++."""
    return Frame(
        _positions(positions),
        None if levels is None else _levels(levels),
        [(name, _attribute(name, value)) for name, value in _by_name(attributes)],
    )


def frame_on_host(positions: Any, levels: Any = None, attributes: Optional[Mapping[str, Any]] = None) -> Frame:
    """Likewise; arrays that lie on a GPU are copied down."""
    return frame(
        on_host(positions, "positions"),
        None if levels is None else on_host(levels, "levels"),
        {name: on_host(value, f"the attribute '{name}'") for name, value in _by_name(attributes)},
    )


def is_on_gpu(value: Any) -> bool:
    """Whether the object lies in the memory of a GPU, as CuPy, Warp, Numba and PyTorch say."""
    return not isinstance(value, np.ndarray) and hasattr(value, "__cuda_array_interface__")


def _name(name: Any) -> str:
    if isinstance(name, str) and 0 < len(name) <= 64 and name.isprintable():
        if (wanted := array_name(name)) == name:
            return name
        raise InvalidInput(f"the name of an attribute is {name!r}, must be of a-z, 0-9 and _, such as {wanted!r}")
    raise InvalidInput(f"the name of an attribute is {repr(name)[:72]}, must be 1 to 64 of a-z, 0-9 and _")


def _as_array(value: Any, what: str) -> Array:
    if is_on_gpu(value):
        raise InvalidInput(
            f"{what} lies on a GPU: copy it to the CPU first, or use a Reconstructor with backend='cuda'"
        )
    if isinstance(value, np.ma.MaskedArray):
        value = _without_mask(value, what)
    if not hasattr(value, "__array__") and hasattr(value, "__dlpack__"):
        if value.__dlpack_device__()[0] not in _DLPACK_CPU:
            raise InvalidInput(f"{what} does not lie in memory of the CPU: copy it there first")
        if not hasattr(np, "from_dlpack"):
            raise InvalidInput(f"{what} has DLPack alone, which numpy reads from 1.22 on; here it is {np.__version__}")
        value = np.from_dlpack(value)
    try:
        # No filter of warnings: those are the whole process's, and calls of several threads would leave theirs behind.
        array = np.asarray(value)
    except (ValueError, TypeError) as error:
        raise InvalidInput(f"{what} is no array of numbers: {error}") from None
    if array.dtype.kind not in "fiub":
        raise InvalidInput(f"{what} is of type {array.dtype}, must be of real numbers")
    return array


def _without_mask(value: Any, what: str) -> Any:
    """Raises InvalidInput where anything is masked: a particle has all of its numbers."""
    masked = int(np.count_nonzero(value.mask))
    if masked > 0:
        raise InvalidInput(
            f"{what} has {masked} masked values, must have none: leave those particles out of all arrays, "
            "as in positions[~numpy.ma.getmaskarray(positions).any(axis=1)].data"
        )
    return value.data


def _positions(value: Any) -> Array:
    if isinstance(value, (str, bytes, os.PathLike)):
        raise InvalidInput(f"positions is {repr(value)[:72]}, must be an array: read_particles() reads a file")
    if isinstance(getattr(value, "positions", None), np.ndarray):  # Particles, or an object like it
        raise InvalidInput(f"positions is of type {type(value).__name__}, must be an array: give its .positions")
    array = _as_array(value, "positions")
    if array.size == 0 and array.ndim in (1, 2):
        return np.empty((0, 3), np.float32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"positions has the shape {array.shape}, must be (N, 3)")
    if array.dtype not in (np.float32, np.float64):
        array = array.astype(np.float64)
    # Rows may lie within larger records; the three numbers of one must not.
    if array.strides[1] != array.itemsize or array.strides[0] < 3 * array.itemsize or not array.dtype.isnative:
        array = np.array(array, dtype=array.dtype.newbyteorder("="), order="C")
    return array


def _levels(value: Any) -> Array:
    array = _as_array(value, "levels")
    if array.ndim != 1 or array.dtype.kind not in "iub" and array.size > 0:
        raise InvalidInput(f"levels is {array.dtype} of the shape {array.shape}, must be (N,) of whole numbers")
    return _within(array, np.uint8, "levels")


def _attribute(name: str, value: Any) -> Array:
    what = f"the attribute '{name}'"
    array = _as_array(value, what)
    if array.ndim not in (1, 2):
        raise InvalidInput(f"{what} has the shape {array.shape}, must be (N,) or (N, components)")
    if array.dtype.kind == "f":
        with np.errstate(over="ignore"):  # infinity is refused where values are looked at
            return np.ascontiguousarray(array, np.float32)
    if array.dtype.kind == "b" or array.dtype == np.uint8:
        return np.ascontiguousarray(array, np.uint8)
    if array.dtype in (np.uint32, np.uint64):
        return _within(array, np.uint32, what)
    return _within(array, np.int32, what)


def _within(array: Array, wanted: Any, what: str) -> Array:
    """The array in the type wanted. Raises InvalidInput for a number that the type does not hold."""
    limits = np.iinfo(wanted)
    if array.size > 0 and (int(array.max()) > limits.max or int(array.min()) < limits.min):
        raise InvalidInput(
            f"{what} has values from {array.min()} to {array.max()}, must lie within {limits.min} to {limits.max}"
        )
    return np.ascontiguousarray(array, wanted)


_DLPACK_CPU = (1, 3, 11)  # in ordinary memory, or pinned for CUDA or ROCm


def device_frame(positions: Any, levels: Any, attributes: Optional[Mapping[str, Any]]) -> tuple[Any, Any, Any]:
    """The ``__cuda_array_interface__`` of each; their forms are looked at in C++. Raises InvalidInput unless all of
    them lie on a GPU."""
    named = _by_name(attributes)
    return (
        _interface("positions", positions),
        None if levels is None else _interface("levels", levels),
        [(name, _interface(f"the attribute '{name}'", value)) for name, value in named],
    )


def _interface(what: str, value: Any) -> dict[str, Any]:
    if not is_on_gpu(value):
        raise InvalidInput(f"positions lies on a GPU, but {what} does not: copy it there")
    interface = value.__cuda_array_interface__
    if not isinstance(interface, Mapping):
        raise InvalidInput(f"the __cuda_array_interface__ of {what} is {type(interface).__name__}, must be a dict")
    # Kept for the call, whatever becomes of the attributes meanwhile.
    return {**interface, "owner": value}


def _by_name(attributes: Optional[Mapping[str, Any]]) -> list[tuple[str, Any]]:
    if attributes is not None and not isinstance(attributes, Mapping):
        given = type(attributes).__name__
        raise InvalidInput(f"attributes is {given}, must be arrays by name, as in {{'velocity': v}}")
    return [(_name(name), value) for name, value in (attributes or {}).items()]


class _Copy:
    """A copy that another library has made in memory of the CPU, for numpy."""

    def __init__(self, capsule: Any) -> None:
        self._capsule = capsule

    def __dlpack__(self, **_: Any) -> Any:
        return self._capsule

    def __dlpack_device__(self) -> tuple[int, int]:
        return _DLPACK_CPU[0], 0


#: How libraries copy an array of theirs to the CPU: cuDF, Numba, CuPy, PyTorch, Warp, JAX.
_COPIES = ("to_numpy", "copy_to_host", "get", "cpu", "numpy", "__array__")


def on_host(value: Any, what: str) -> Any:
    """The value, copied down by its library where it lies on a GPU. Raises InvalidInput where it cannot be."""
    if not is_on_gpu(value) and not _is_elsewhere(value):
        return value
    if hasattr(value, "detach"):  # from PyTorch's gradients
        value = value.detach()
    try:
        # Since 2023 the protocol can be asked for a copy on another device.
        return np.from_dlpack(_Copy(value.__dlpack__(dl_device=(_DLPACK_CPU[0], 0), copy=True)))
    except (AttributeError, TypeError, BufferError, RuntimeError, NotImplementedError):
        pass
    for name in _COPIES:
        if callable(copy := getattr(value, name, None)):
            try:
                return np.asarray(copy())
            except TypeError:
                continue  # CuPy's __array__ refuses; another library's get() is of something else
    kind = type(value).__name__
    raise InvalidInput(f"{what} lies on a GPU, and {kind} offers no copy in memory of the CPU: make one")


def _is_elsewhere(value: Any) -> bool:
    """Whether it says by DLPack that it does not lie in memory of the CPU."""
    is_other = not isinstance(value, np.ndarray) and hasattr(value, "__dlpack_device__")
    return is_other and value.__dlpack_device__()[0] not in _DLPACK_CPU
