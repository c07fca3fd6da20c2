"""A simulation that calls back after each step, as solvers in Warp or Genesis do: callback_loop.py [ADDRESS [OUT.ply]]

The callback never holds the simulation up: a frame that the server is not ready for is left out. The last surface that
came back goes to a file.
"""

import sys
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

import meniscus


class DeviceArray:
    """Stands for the array of a solver: it is no numpy array, and gives one when it is asked."""

    def __init__(self, values: NDArray[np.float32]) -> None:
        self.values = values

    def __array__(self, dtype: Any = None) -> NDArray[Any]:
        return self.values if dtype is None else self.values.astype(dtype)


class StandingWave:
    """Stands for the solver: water in a tank, 2 m by 1 m, 0.4 m deep, that sways."""

    spacing = 0.05

    def __init__(self) -> None:
        axes = [np.arange(self.spacing / 2, extent, self.spacing, dtype=np.float32) for extent in (2.0, 1.0, 0.4)]
        self.rest = np.stack(np.meshgrid(*axes), -1).reshape(-1, 3)
        self.time = 0.0

    def run(self, steps: int, dt: float, callback: Callable[[int, float, DeviceArray, DeviceArray], None]) -> None:
        shape = 0.1 * np.cos(np.pi / 2 * self.rest[:, 0]) * self.rest[:, 2] / 0.4
        for step in range(steps):
            self.time += dt
            x, v = self.rest.copy(), np.zeros_like(self.rest)
            x[:, 2] += shape * np.sin(4 * self.time)
            v[:, 2] = 4 * shape * np.cos(4 * self.time)
            callback(step, self.time, DeviceArray(x), DeviceArray(v))


class Surfaces:
    """The callback: particles go out, meshes come in, and neither is waited for."""

    def __init__(self, stream: meniscus.Stream) -> None:
        self.stream = stream
        self.left_out = 0
        self.newest: meniscus.Frame | None = None

    def __call__(self, step: int, time: float, positions: DeviceArray, velocities: DeviceArray) -> None:
        if not self.stream.try_push(positions, attributes={"velocity": velocities}, time=time, index=step):
            self.left_out += 1
        self.take()

    def take(self) -> None:
        for self.newest in self.stream.ready():
            print(f"step {self.newest.index}: {self.newest.statistics.triangles} triangles")


def main(address: str = "127.0.0.1:50051", out: str = "callback_loop.ply") -> None:
    client = meniscus.Client(address)
    with client.session(StandingWave.spacing / 2, name="callback", up_axis="z") as session:
        with session.stream() as stream:
            surfaces = Surfaces(stream)
            StandingWave().run(200, 0.01, surfaces)
        surfaces.take()
    print(f"{surfaces.left_out} steps were left out, {stream.dropped} dropped")
    if surfaces.newest is not None:
        surfaces.newest.mesh.save(out)
        speed = np.linalg.norm(surfaces.newest.mesh.attributes["velocity"], axis=1)
        print(f"{out}: {surfaces.newest.mesh}, at most {speed.max():.2f} m/s")


if __name__ == "__main__":
    main(*sys.argv[1:])
