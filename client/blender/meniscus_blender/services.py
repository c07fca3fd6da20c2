"""The threads beside Blender while the add-on is registered: the worker, and the followers of live sessions."""

from .cache import SurfaceCache
from .reconstruction import Reconstruction
from .worker import Worker

reconstruction = None
worker = None
followers = {}  #: live.Follower by the key of its object


def start(cache_folder, cache_bytes):
    global reconstruction, worker
    reconstruction = Reconstruction(SurfaceCache(cache_folder, cache_bytes))
    worker = Worker(reconstruction.make, reconstruction.prepare)


def configure_cache(folder, max_bytes):
    if reconstruction is not None:
        reconstruction.cache = SurfaceCache(folder, max_bytes)


def stop_followers():
    for follower in followers.values():
        follower.stop(seconds=0.0)  # one that is connecting ends when it has
    followers.clear()


def stop():
    global reconstruction, worker
    stop_followers()
    if worker is not None:
        worker.close()
    reconstruction = worker = None
