"""The Python package meniscus, brought into ParaView's process."""

from __future__ import annotations

import os
import sys


class Refusal(Exception):
    """What this plugin itself has to object to, in one line for the user."""


def meniscus_package():
    """The package. ParaView has a protobuf of its own, some names of which are also in the one that Meniscus uses: they
    stay apart only if Meniscus looks into its own libraries first."""
    if "meniscus" not in sys.modules:
        flags = sys.getdlopenflags()
        sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL | os.RTLD_DEEPBIND)
        try:
            import meniscus  # noqa: F401
        except ImportError as error:
            raise Refusal(
                f"the Python package meniscus is not there ({error}): install python3-meniscus, or name its folder in "
                f"PYTHONPATH; ParaView runs Python {sys.version_info.major}.{sys.version_info.minor} ({sys.prefix})"
            ) from None
        finally:
            sys.setdlopenflags(flags)
    return sys.modules["meniscus"]
