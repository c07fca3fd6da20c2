"""Calls that a type checker has to let pass. Never run."""

from typing import Any

import numpy as np

import meniscus

x = np.zeros((10, 3))
anything: Any = x
settings: dict[str, Any] = {"iso": 0.5}
particles = meniscus.read_particles("frame.vtk")

meniscus.reconstruct(x, np.float32(0.1), cell_size=1, threads=np.int64(2), domain=((0, 0, 0), (1, 1, 1)))
meniscus.reconstruct(anything, 0.1, levels=[0] * 10, attributes={"velocity": x, "id": np.arange(10)})
meniscus.reconstruct([[0.0, 0.0, 0.0]], 0.1, domain=np.zeros((2, 3)), tolerance=None, **settings)
meniscus.reconstruct(particles.positions, 0.1, levels=particles.levels, attributes=particles.attributes)
client = meniscus.Client("127.0.0.1:50051", wait=5)
with client.session(0.1, name="dam", up_axis="z", field="color", iso=0.5) as session:
    with session.stream(attributes={"velocity": 12}, policy="every-nth", nth=2, reconnect=30) as stream:
        index: int = stream.push(x, attributes={"velocity": x}, time=np.float64(1.0), index=3)
    with client.publish(session, codec="entropy", parts=2, part=1, run=7) as publisher:
        place: int = publisher.push(meniscus.reconstruct(x, 0.1, keep_lattice=True), time=1, index=np.int64(2))
        publisher.push(meniscus.reconstruct(x, 0.1, keep_lattice=True), bricks=((None, 0, 0), [1, np.int32(2), None]))
    for frame in client.watch(session, max_level=2, viewpoint=(0, 0, 1), attributes=["velocity"]):
        size: float = frame.mesh.area + frame.mesh.volume + float(frame.mesh.bounds[0, 0])
    for info in client.sessions():
        client.snapshot(info, codec="draco")
    meniscus.show(session, color="velocity")
for recording in client.recordings():
    client.read_recording(recording, count=5)
publication = meniscus.publish([meniscus.reconstruct(x, 0.1)], "site", name="dam", keep=60, page=True)
published: float = meniscus.open("https://water.example/site/")[0].mesh.area + len(publication)
meniscus.publish(client.watch("dam"), "live", live=True)
