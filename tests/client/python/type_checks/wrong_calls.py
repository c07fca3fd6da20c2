"""Calls that a type checker has to refuse, each in a line of its own; check_types.py counts them. Never run."""

import numpy as np

import meniscus

x = np.zeros((10, 3), np.float32)
client = meniscus.Client("127.0.0.1:50051")
reconstructor = meniscus.Reconstructor(0.1)
session = client.session(0.1)
stream = session.stream()

meniscus.reconstruct(x, particle_radius=0.1, cel_size=3)  # wrong
meniscus.reconstruct(x, particle_radius=0.1, iso="abc")  # wrong
meniscus.reconstruct("file.vtk", 0.1)  # wrong
meniscus.reconstruct(x)  # wrong
meniscus.reconstruct(x, 0.1, preset="smoth")  # wrong
meniscus.reconstruct(x, 0.1, field="colour")  # wrong
meniscus.reconstruct(x, 0.1, smoothness=6.5)  # wrong
meniscus.reconstruct(x, 0.1, attributes=["velocity"])  # wrong
meniscus.Reconstructor(particle_radius="0.1")  # wrong
meniscus.Reconstructor(0.1, threads=2.5)  # wrong
meniscus.Reconstructor(0.1, domain=4.0)  # wrong
reconstructor.reconstruct(x, levels="fine")  # wrong
reconstructor.reconstruct(x, velocity=x)  # wrong
reconstructor.coarser("2")  # wrong
meniscus.Client(50051)  # wrong
meniscus.Client("water.example", tls=True)  # wrong
client.session(0.1, nme="dam")  # wrong
client.session(0.1, up_axis="w")  # wrong
client.session(0.1, threads=2)  # wrong
client.watch("dam", maxlevel=2)  # wrong
client.watch("dam", region=1.0)  # wrong
client.watch(5)  # wrong
client.awatch("dam", max_particles=5)  # wrong
client.snapshot("dam", max_level="2")  # wrong
client.stream("dam", polcy="latest")  # wrong
session.stream(policy="newest")  # wrong
session.watch_particles(max_level=1)  # wrong
stream.push("file.vtk")  # wrong
stream.push(x, time="now")  # wrong
stream.apush(x, velocity=x)  # wrong
session.publish(meshes=False)  # wrong
session.publish().push(x)  # wrong
session.publish().push(reconstructor.reconstruct(x), bricks=3)  # wrong
client.publish("dam", attribute_bits="all")  # wrong
meniscus.read_particles(5)  # wrong
meniscus.show("dam")  # wrong
meniscus.open(5)  # wrong
meniscus.publish([x], "site")  # wrong
