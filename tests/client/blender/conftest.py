"""The add-on's modules that need no Blender, imported as the package that they are."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "client" / "blender"))
