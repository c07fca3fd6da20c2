"""Frames of particles for the pipe of ``meniscus push -``, by numpy alone: where neither gRPC nor this package is.

    python3 piped_frames.py | meniscus push - --server localhost --particle-radius 0.025 --attribute speed

In a program with mpi4py, rank 0 gathers the particles of all and writes them into the pipe.
"""

import struct
import sys
from collections.abc import Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

TYPES = {np.dtype("<f4"): 1, np.dtype("<u1"): 2, np.dtype("<i4"): 4, np.dtype("<u4"): 5}
CHUNK = 1 << 20


def varint(number: int) -> bytes:
    out = b""
    while number >= 0x80:
        out, number = out + bytes([number & 0x7F | 0x80]), number >> 7
    return out + bytes([number])


def field(number: int, value: Union[int, float, bytes]) -> bytes:
    """A field of a message: a whole number, a float64, or bytes."""
    if isinstance(value, float):
        return varint(number << 3 | 1) + struct.pack("<d", value)
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def delimited(message: bytes) -> bytes:
    return varint(len(message)) + message


def beginning() -> bytes:
    """Of a recording: proto/meniscus/v1/recording.proto. The settings are flags of the command."""
    return b"Meniscus recording\n" + delimited(field(1, field(1, 2)))


def frame(index: int, time: float, arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """arrays by name: float32 "position" (N, 3) comes first, then what particles carry, such as "speed" (N,)."""
    count = len(arrays["position"])
    forms = [
        field(1, name.encode()) + field(2, TYPES[array.dtype]) + field(3, array[0].size)
        for name, array in arrays.items()
    ]
    head = field(1, index) + field(2, time) + field(3, count)
    messages = delimited(field(2, head + b"".join(field(7, form) for form in forms)))
    values = b"".join(array.tobytes() for array in arrays.values())
    for first in range(0, len(values), CHUNK):
        messages += delimited(field(3, field(1, values[first : first + CHUNK])))
    messages += delimited(field(4, b""))
    return delimited(field(2, head) + field(4, len(messages))) + messages


x = np.stack(np.meshgrid(*[np.arange(0.1, 0.9, 0.05)] * 3), -1).reshape(-1, 3)  # (4096, 3), metres: a cube of water
sys.stdout.buffer.write(beginning())
for step in range(20):
    a, b = np.pi * x[:, 0], np.pi * x[:, 2]  # vortices that keep the water's volume
    v = np.stack((np.sin(a) * np.cos(b), 0 * a, -np.cos(a) * np.sin(b)), -1)  # metres per second
    x += v * 0.01
    speed = np.linalg.norm(v, axis=1)
    sys.stdout.buffer.write(frame(step, step * 0.01, {"position": x.astype("<f4"), "speed": speed.astype("<f4")}))
    sys.stdout.buffer.flush()
