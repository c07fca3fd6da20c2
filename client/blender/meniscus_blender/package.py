"""The Python package meniscus, which does the work; where it cannot be imported, what this Blender lacks."""

import importlib
import importlib.machinery
import importlib.util
import os
import platform
import sys
import sysconfig
import time


class PackageMissing(RuntimeError):
    """The message says which wheel this Blender needs, and why the package could not be imported."""


def meniscus():
    """The package. Raises PackageMissing."""
    try:
        return importlib.import_module("meniscus")
    except Exception as error:  # of a wheel for another Python, the loader raises errors of many kinds
        raise PackageMissing(_missing_text(error)) from error


def missing():
    """The text of PackageMissing, or ""; looked up anew every five seconds at most, for what is drawn often."""
    global _looked, _missing
    if time.monotonic() - _looked > 5.0:
        _looked, _missing = time.monotonic(), ""
        try:
            meniscus()
        except PackageMissing as error:
            _missing = str(error)
    return _missing


_looked, _missing = float("-inf"), ""


def python_tag():
    """The tag of this Blender's Python in names of wheels, such as "cp311"."""
    return f"cp{sys.version_info[0]}{sys.version_info[1]}"


def platform_tag():
    """The tag of this machine in names of wheels, such as "linux_x86_64"."""
    return sysconfig.get_platform().replace("-", "_").replace(".", "_")


def wheel_name():
    """The wheel that this Blender takes, such as "meniscus-*-cp311-cp311-linux_x86_64.whl"."""
    return f"meniscus-*-{python_tag()}-{python_tag()}-{platform_tag()}.whl"


def platform_text():
    """This Blender's Python and machine."""
    library, version = platform.libc_ver()
    beside = f", {library} {version}" if library else ""
    return f"Python {platform.python_version()}, {platform.system()} {platform.machine()}{beside}"


def uses_debians_python():
    """Whether this Blender imports what Debian's packages install."""
    return os.path.exists("/etc/debian_version") and sys.prefix == "/usr"


def _missing_text(error):
    if isinstance(error, ModuleNotFoundError) and error.name == "meniscus":
        reason = "none is installed"
    else:
        reason = _unfit_library() or f"{type(error).__name__}: {error}"
    needed = f"needs {wheel_name()}"
    if uses_debians_python():
        needed = f"needs Debian's package of it (apt install ./python3-meniscus_*.deb), or {wheel_name()}"
    return f"the Python package meniscus is missing: this Blender ({platform_text()}) {needed}; {reason}"


def _unfit_library():
    """Why the library of an installed package does not fit this interpreter; "" if it fits or there is none."""
    found = importlib.util.find_spec("meniscus")
    folders = (found.submodule_search_locations if found else None) or []
    names = [name for folder in folders for name in os.listdir(folder) if name.startswith("_meniscus.")]
    libraries = sorted(name for name in names if name.endswith((".so", ".pyd")))
    fitting = {"_meniscus" + suffix for suffix in importlib.machinery.EXTENSION_SUFFIXES}
    if fitting.intersection(libraries):
        return ""
    return "the one that is installed is for another Python: " + ", ".join(libraries) if libraries else ""


def load_anew(folder):
    """The package that has come into a folder of modules since. Raises PackageMissing."""
    if folder not in sys.path:
        sys.path.append(folder)
    global _looked
    _looked = float("-inf")
    importlib.invalidate_caches()
    for name in [name for name in sys.modules if name == "meniscus" or name.startswith("meniscus.")]:
        if not hasattr(sys.modules.get("meniscus"), "Reconstructor"):  # one that is complete stays until Blender ends
            del sys.modules[name]
    return meniscus()
