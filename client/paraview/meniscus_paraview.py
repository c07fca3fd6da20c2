"""The plugin for ParaView: a live session, a recording on a server, files of surfaces. README.md says how to load it.

Its sources give polygons: normals and the particles' attributes as point data, the level of grid as cell data (1, 2, 3;
crack filling 0), the frame's number and time as field data.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from meniscus_sources.reader import MeniscusSurfaces  # noqa: E402
from meniscus_sources.recording import MeniscusRecording  # noqa: E402
from meniscus_sources.session import MeniscusSession  # noqa: E402

paraview_plugin_name = "Meniscus"

__all__ = ["MeniscusRecording", "MeniscusSession", "MeniscusSurfaces"]
