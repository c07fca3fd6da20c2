"""Loads the plugin meniscus_paraview.py, also where ParaView is older than its Python (Debian 12: 5.11 with 3.11).

paraview --script=load_meniscus.py; or, in pvpython and in ParaView's Python shell, import load_meniscus.
"""

import inspect
import os
import sys

from paraview.simple import LoadPlugin

# ParaView up to 5.11 reads plugins by a function that Python 3.11 has no longer; its successor serves as well.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

# A script that ParaView's window runs has no __file__.
folders = [os.path.dirname(os.path.abspath(__file__))] if "__file__" in globals() else []
folders += [*sys.path, os.path.join(sys.prefix, "share", "meniscus", "paraview")]
plugins = [os.path.join(folder, "meniscus_paraview.py") for folder in folders]
found = [plugin for plugin in plugins if os.path.exists(plugin)]
if not found:
    raise FileNotFoundError(f"meniscus_paraview.py is in none of {folders}: name its folder in PYTHONPATH")
LoadPlugin(found[0], ns=globals())
