"""Surfaces of SPH particles in Blender: of files, reconstructed when the frame changes, and of live sessions.

Nothing here imports Blender before it registers the add-on, so that the tests can use the modules without it.
"""

bl_info = {
    "name": "Meniscus",
    "author": "The Meniscus authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > SPH Particles, and 3D Viewport > Sidebar > Meniscus",
    "description": "Surfaces of SPH particles: sequences of files, and live sessions of a meniscusd",
    "category": "Import-Export",
}


def register():
    from . import registration

    registration.register()


def unregister():
    from . import registration

    registration.unregister()
