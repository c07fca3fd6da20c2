"""Installing a wheel without pip, which a Blender may lack: a wheel is an archive of what has to lie beside others."""

import os
import shutil
import tempfile
import zipfile

from . import package


class WheelError(ValueError):
    """The file is no wheel of meniscus for this Blender. The message says what is."""


def install(path, folder):
    """Puts the wheel's packages into a folder of modules, in place of those that are there. Gives their names.

    Raises WheelError, and OSError where nothing can be written; what was installed before is then still there.
    """
    _check_name(os.path.basename(path))
    os.makedirs(folder, exist_ok=True)
    unpacked = tempfile.mkdtemp(prefix=".meniscus-", dir=folder)
    try:
        try:
            with zipfile.ZipFile(path) as archive:
                _check_names(archive.namelist())
                archive.extractall(unpacked)
        except zipfile.BadZipFile as error:
            raise WheelError(f"{path} is damaged: {error}") from None
        names = sorted(os.listdir(unpacked))
        for name in names:
            _replace(os.path.join(folder, name), os.path.join(unpacked, name), os.path.join(unpacked, "old " + name))
        return names
    finally:
        shutil.rmtree(unpacked, ignore_errors=True)


def _replace(there, new, aside):
    if os.path.exists(there):
        os.rename(there, aside)
    try:
        os.rename(new, there)
    except OSError:
        if os.path.exists(aside):
            os.rename(aside, there)
        raise


def _check_name(name):
    parts = name[: -len(".whl")].split("-") if name.endswith(".whl") else []
    if len(parts) not in (5, 6) or parts[0] != "meniscus":
        raise WheelError(f"{name} is no wheel of meniscus: choose {package.wheel_name()}")
    python, _, machine = parts[-3:]
    fits = package.python_tag() in python.split(".") and any(_same_machine(tag) for tag in machine.split("."))
    if not fits:
        raise WheelError(f"{name} is for {python} on {machine}: this Blender needs {package.wheel_name()}")


def _same_machine(tag):
    """manylinux_2_36_x86_64 is linux_x86_64 with the age of its C library."""
    system, machine = package.platform_tag().split("_", 1)
    return tag.endswith(machine) and tag.startswith((system, "many" + system)) if system == "linux" else system in tag


def _check_names(names):
    for name in names:
        parts = name.split("/")
        if name.startswith("/") or "\\" in name or ".." in parts or not parts[0].startswith("meniscus"):
            raise WheelError(f"the wheel has the file {name!r}, which is none of meniscus")
    if not any(name.startswith("meniscus/") for name in names):
        raise WheelError("the wheel has no package meniscus")
