"""The wheel: the modules, the extension, and the libraries that the extension needs. Offline, with Debian's setuptools:

    /usr/bin/python3 -m venv --system-site-packages V
    V/bin/pip wheel --no-build-isolation --no-deps client/python -w out

The extension is built by CMake for the Python that runs this. BUILT_MENISCUS names a build folder that has it already.
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

REPOSITORY = Path(__file__).resolve().parents[2]


def require_tools() -> None:
    """Before anything is built: what is missing at the end of it costs minutes."""
    missing = [tool for tool in ("patchelf", "strip") if shutil.which(tool) is None]
    if missing:
        raise SystemExit(f"setup.py: the wheel needs {' and '.join(missing)}: run deploy/install-packages wheel")


def built_by_cmake() -> Path:
    """A build folder with the extension for this Python."""
    if given := os.environ.get("BUILT_MENISCUS"):
        return Path(given)
    build = REPOSITORY / ".build" / f"wheel-{sys.implementation.cache_tag}"
    settings = {
        "CMAKE_BUILD_TYPE": "Release",
        "MENISCUS_ALL_GPUS": "ON",
        "MENISCUS_PYTHON": "ON",
        "MENISCUS_TESTS": "OFF",
        "MENISCUS_WEB": "OFF",
        "Python_EXECUTABLE": sys.executable,
    }
    # A pybind11 of this Python's own serves it better than the system's, which may be older than it.
    own = subprocess.run([sys.executable, "-m", "pybind11", "--cmakedir"], capture_output=True, text=True)
    if own.returncode == 0:
        settings["pybind11_DIR"] = own.stdout.strip()
    flags = [f"-D{name}={value}" for name, value in settings.items()]
    subprocess.run(["cmake", "-G", "Ninja", "-S", REPOSITORY, "-B", build, *flags], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "meniscus_python"], check=True)
    return build


def carry_libraries(extension: Path, libraries: Path) -> None:
    """Puts the libraries behind the extension beside it, with their licenses.

    Each has the hash of its bytes in its name. Otherwise the first library of a name that a process loads would serve
    all that ask for the name: our OpenSSL, say, the ssl module of a newer system's Python.
    """
    packed = libraries / "packed"
    pack_libraries = REPOSITORY / "deploy" / "pack-libraries"
    subprocess.run([pack_libraries, "--for-python", packed, libraries / "licenses", extension], check=True)
    shutil.copy(REPOSITORY / "LICENSE", libraries / "licenses")
    names = {}
    for path in sorted(packed.iterdir()):
        digest = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
        names[path.name] = path.name.replace(".so", f"-{digest}.so", 1)
        path.rename(libraries / names[path.name])
    packed.rmdir()
    for name in names.values():
        patch(libraries / name, names, "$ORIGIN", "--set-soname", name)
    patch(extension, names, f"$ORIGIN/../{libraries.name}")


def patch(file: Path, names: dict[str, str], folder: str, *more: str) -> None:
    """Lets a library look for those it needs by their new names in a folder."""
    file.chmod(0o755)
    needed = subprocess.run(["patchelf", "--print-needed", file], check=True, capture_output=True, text=True)
    carried = [name for name in needed.stdout.split() if name in names]
    renamed = [word for name in carried for word in ("--replace-needed", name, names[name])]
    # An rpath, not a runpath: it goes before LD_LIBRARY_PATH. patchelf 0.14 loses names if it does all in one call.
    for arguments in (renamed, ["--force-rpath", "--set-rpath", folder, *more]):
        if arguments:
            subprocess.run(["patchelf", *arguments, file], check=True)


class BuildByCMake(build_ext):
    def build_extension(self, ext: Extension) -> None:
        require_tools()
        name = "_meniscus" + sysconfig.get_config_var("EXT_SUFFIX")
        build = built_by_cmake()
        built = build / "client" / "python" / "meniscus" / name
        if not built.is_file():
            raise SystemExit(f"{built} is not there: build the target meniscus_python for this Python")
        extension = Path(self.get_ext_fullpath(ext.name))
        extension.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["strip", "--strip-unneeded", "-o", extension, built], check=True)
        libraries = Path(self.build_lib).resolve() / "meniscus.libs"
        carry_libraries(extension.resolve(), libraries)
        if re.search(r"^CMAKE_CUDA_COMPILER:.*=/", (build / "CMakeCache.txt").read_text(), re.MULTILINE):
            terms = "The extension contains NVIDIA's CUDA runtime, under https://docs.nvidia.com/cuda/eula/\n"
            (libraries / "licenses" / "cuda-runtime").write_text(terms)


version = re.search(r"project\(Meniscus VERSION ([\d.]+)", (REPOSITORY / "CMakeLists.txt").read_text())
assert version, "CMakeLists.txt names no version"
# Nothing is written beside the sources.
with tempfile.TemporaryDirectory() as scratch:
    setup(
        version=version.group(1),
        ext_modules=[Extension("meniscus._meniscus", [])],
        cmdclass={"build_ext": BuildByCMake},
        options={"build": {"build_base": scratch}, "egg_info": {"egg_base": scratch}},
    )
