"""The types of what callers give, for editors and type checkers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Protocol, Sequence, Union

import numpy as np

if TYPE_CHECKING:  # from numpy 1.20 on
    from numpy.typing import NDArray

Real = Union[float, "np.floating[Any]", "np.integer[Any]"]
Whole = Union[int, "np.integer[Any]"]


class SupportsArray(Protocol):
    """What numpy makes an array of: tables of pandas, tensors of PyTorch."""

    def __array__(self) -> Any:
        ...


class SupportsDLPack(Protocol):
    """An array of another library, on the CPU or a device."""

    def __dlpack__(self) -> Any:
        ...

    def __dlpack_device__(self) -> Any:
        ...


class OnGpu(Protocol):
    """An array on a GPU: of CuPy, Warp, Numba or PyTorch."""

    @property
    def __cuda_array_interface__(self) -> Any:
        ...


#: An array of particles. Narrower than numpy's own type of this name, which a path would be, too.
ArrayLike = Union["NDArray[Any]", SupportsArray, SupportsDLPack, OnGpu, Sequence[Real], Sequence[Sequence[Real]]]
#: Three numbers, world units.
Point = Union[Sequence[Real], "NDArray[Any]"]
#: The smallest and the largest corner, world units.
Box = Union[Sequence[Point], "NDArray[Any]"]
#: The lowest and the highest brick, both among them: x y z of each, None for no end.
BrickBox = Sequence[Sequence[Optional[Whole]]]
