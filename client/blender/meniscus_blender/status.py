"""The panel's text about each object: the surface that it shows, or an error. It is not saved with the file."""

import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Status:
    text: str
    kind: str = "INFO"  #: or WARNING, ERROR
    fitting_radius: float = 0.0  #: that a warning proposes; 0: none


_by_object = {}


def of(name):
    """The status of the object of that name, or None."""
    return _by_object.get(name)


def show(name, text, kind="INFO", fitting_radius=0.0, aloud=False):
    """aloud: an error or a warning is also written to stderr, for a Blender without windows."""
    status = Status(text, kind, fitting_radius)
    if aloud and kind != "INFO" and _by_object.get(name) != status:
        print(f"meniscus: {kind.lower()}: {name}: {text}", file=sys.stderr, flush=True)
    _by_object[name] = status


def forget():
    _by_object.clear()
