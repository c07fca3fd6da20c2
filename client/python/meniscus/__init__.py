"""Meniscus turns simulated fluid particles into surfaces, here or on a server.

A surface of one frame, computed in this process:

    >>> import numpy, meniscus
    >>> positions = numpy.random.default_rng(0).random((20000, 3))      # (N, 3), world units
    >>> mesh = meniscus.reconstruct(positions, particle_radius=0.02)
    >>> mesh.vertices, mesh.triangles, mesh.normals                     # numpy arrays
    >>> mesh.save("water.ply")

``particle_radius`` is half the distance between neighboring particles at rest. Attributes of the particles reach the
vertices:

    >>> mesh = meniscus.reconstruct(positions, particle_radius=0.02, attributes={"velocity": velocity})
    >>> mesh.attributes["velocity"]

Frames of a simulation, live, through a server (``meniscusd``), whose viewer in the browser shows them:

    >>> client = meniscus.Client("127.0.0.1:50051")
    >>> with client.session(particle_radius=0.02, name="dam") as session, session.stream() as stream:
    ...     for step in range(100):
    ...         stream.push(positions, attributes={"velocity": velocity}, time=step * 0.01)
    ...         for frame in stream.ready():
    ...             print(frame.index, len(frame.mesh.triangles))

Surfaces that are made here, for the watchers of a session:

    >>> reconstructor = meniscus.Reconstructor(0.02, keep_lattice=True)
    >>> with client.session(particle_radius=0.02) as session, session.publish() as publisher:
    ...     publisher.push(reconstructor.reconstruct(positions), time=0.0)

Somebody else's session:

    >>> [(info.id, info.name) for info in client.sessions()]
    >>> for frame in client.watch(session_id, max_level=2):
    ...     print(frame.index, frame.statistics.triangles)

A surface as plain files, which any web host carries, written and read back:

    >>> meniscus.publish(meniscus.RecordingFile("000001.recording"), "site", page=True)
    >>> [len(frame.mesh.triangles) for frame in meniscus.open("https://water.example/site/")]

Everything that is wrong raises one of meniscus.InvalidInput, LimitExceeded, DeviceError and ServerError, all of them
meniscus.Error. Read on at Reconstructor (the settings), Client and Mesh.
"""

from ._meniscus import __version__
from .client import Client
from .errors import DeviceError, Error, ForkedError, InvalidInput, LimitExceeded, ServerError, SurfaceWarning
from .files import Particles, mesh_extensions, particle_extensions, read_particles
from .frame import AttributeForm, Frame, ParticleFrame
from .information import RecordingInfo, ServerInfo, SessionInfo
from .mesh import DeviceArray, DeviceMesh, Mesh
from .publication import Publication, open, publish
from .publisher import Publisher
from .reconstructor import Reconstructor, reconstruct
from .recording_file import RecordingFile, read_bricks
from .server import Server
from .session import Session
from .statistics import FrameWarning, Statistics
from .stream import Stream
from .view import View, show
from .watcher import ParticleWatcher, RecordingReader, Watcher

__all__ = [
    "AttributeForm",
    "Client",
    "DeviceArray",
    "DeviceError",
    "DeviceMesh",
    "Error",
    "ForkedError",
    "Frame",
    "FrameWarning",
    "InvalidInput",
    "LimitExceeded",
    "Mesh",
    "ParticleFrame",
    "ParticleWatcher",
    "Particles",
    "Publication",
    "Publisher",
    "Reconstructor",
    "RecordingFile",
    "RecordingInfo",
    "RecordingReader",
    "Server",
    "ServerError",
    "ServerInfo",
    "Session",
    "SessionInfo",
    "Statistics",
    "Stream",
    "SurfaceWarning",
    "View",
    "Watcher",
    "__version__",
    "mesh_extensions",
    "open",
    "particle_extensions",
    "publish",
    "read_bricks",
    "read_particles",
    "reconstruct",
    "show",
]
