"""A Blender without the package, and a wheel for it."""

import os
import sys
import zipfile

import pytest

from meniscus_blender import package, wheel


@pytest.fixture
def modules(tmp_path, monkeypatch):
    """A folder of modules, alone on the path of what is imported."""
    monkeypatch.setattr(sys, "path", [str(tmp_path / "modules")] + [p for p in sys.path if "meniscus" not in p])
    for name in [name for name in sys.modules if name.split(".")[0] == "meniscus"]:
        monkeypatch.delitem(sys.modules, name)
    (tmp_path / "modules").mkdir()
    yield tmp_path / "modules"
    for name in [name for name in sys.modules if name.split(".")[0] == "meniscus"]:
        del sys.modules[name]


def put(folder, **files):
    (folder / "meniscus").mkdir()
    for name, text in files.items():
        (folder / "meniscus" / (name + ".py")).write_text(text)


def make_wheel(
    folder, name=None, files=("meniscus/__init__.py", "meniscus-1.0.dist-info/METADATA"), text="Reconstructor = 1"
):
    tag = package.python_tag()
    path = folder / (name or f"meniscus-1.0-{tag}-{tag}-{package.platform_tag()}.whl")
    with zipfile.ZipFile(path, "w") as archive:
        for file in files:
            archive.writestr(file, text)
    return path


def test_a_blender_without_the_package_names_the_wheel(modules):
    if any(os.path.isdir(os.path.join(folder, "meniscus")) for folder in sys.path):
        pytest.skip("the package is installed among those of the system")
    with pytest.raises(package.PackageMissing) as raised:
        package.meniscus()
    version = "".join(map(str, sys.version_info[:2]))
    for part in (
        f"meniscus-*-cp{version}-cp{version}-",
        package.platform_tag(),
        sys.version.split()[0],
        "none is installed",
    ):
        assert part in str(raised.value)


@pytest.mark.parametrize("is_debians", [True, False])
def test_on_debian_the_package_of_debian_is_named(modules, monkeypatch, is_debians):
    put(modules, __init__="import nothing_of_this_name")
    monkeypatch.setattr(package, "uses_debians_python", lambda: is_debians)
    with pytest.raises(package.PackageMissing) as raised:
        package.meniscus()
    assert ("python3-meniscus_*.deb" in str(raised.value)) == is_debians
    assert package.wheel_name() in str(raised.value)


def test_a_package_for_another_python_is_reported(modules):
    put(modules, __init__="from ._meniscus import __version__")
    (modules / "meniscus" / "_meniscus.cpython-37m-x86_64-linux-gnu.so").touch()
    with pytest.raises(package.PackageMissing, match="for another Python: _meniscus.cpython-37m-x86_64-linux-gnu.so"):
        package.meniscus()


def test_a_package_that_cannot_be_loaded_gives_the_reason(modules):
    put(modules, __init__="raise ImportError('libtbb.so.12: cannot open shared object file')")
    with pytest.raises(package.PackageMissing, match="ImportError: libtbb.so.12: cannot open shared object file"):
        package.meniscus()


def test_a_wheel_is_installed_and_found_in_the_same_process(modules, tmp_path):
    with pytest.raises(package.PackageMissing):
        put(modules, __init__="import nothing_of_this_name")
        package.meniscus()
    names = wheel.install(make_wheel(tmp_path), modules)
    assert names == ["meniscus", "meniscus-1.0.dist-info"]
    assert package.load_anew(str(modules)).Reconstructor == 1
    assert sorted(path.name for path in modules.iterdir() if path.name != "__pycache__") == names


@pytest.mark.parametrize(
    "machine", ["manylinux_2_36_x86_64", "manylinux_2_17_x86_64.manylinux2014_x86_64", "linux_x86_64"]
)
def test_wheels_for_this_machine_fit(tmp_path, monkeypatch, machine):
    monkeypatch.setattr(package, "platform_tag", lambda: "linux_x86_64")
    tag = package.python_tag()
    assert wheel.install(make_wheel(tmp_path, f"meniscus-1.0-{tag}-{tag}-{machine}.whl"), tmp_path / "modules")


@pytest.mark.parametrize(
    "name, text",
    [
        ("meniscus-1.0-cp37-cp37m-linux_x86_64.whl", "is for cp37 on linux_x86_64: this Blender needs meniscus"),
        (f"meniscus-1.0-{package.python_tag()}-abi3-win_amd64.whl", "on win_amd64: this Blender needs"),
        (f"meniscus-1.0-{package.python_tag()}-abi3-manylinux_2_36_aarch64.whl", "aarch64: this Blender needs"),
        ("numpy-1.0-cp311-cp311-linux_x86_64.whl", "is no wheel of meniscus"),
        ("meniscus.whl", "is no wheel of meniscus"),
        ("meniscus-1.0.tar.gz", "is no wheel of meniscus"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path, monkeypatch, name, text):
    monkeypatch.setattr(package, "platform_tag", lambda: "linux_x86_64")
    with pytest.raises(wheel.WheelError, match=text):
        wheel.install(make_wheel(tmp_path, name), tmp_path / "modules")


@pytest.mark.parametrize(
    "file",
    ["../evil.py", "/meniscus/evil.py", "meniscus/../../evil.py", "os.py", "meniscus\\..\\evil.py", "sitecustomize.py"],
)
def test_a_wheel_writes_nothing_but_its_own(tmp_path, file):
    modules = tmp_path / "modules"
    with pytest.raises(wheel.WheelError, match="none of meniscus"):
        wheel.install(make_wheel(tmp_path, files=("meniscus/__init__.py", file)), modules)
    assert list(modules.iterdir()) == []


def test_a_damaged_wheel_leaves_what_was_installed(tmp_path):
    modules = tmp_path / "modules"
    path = make_wheel(tmp_path)
    wheel.install(path, modules)
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(wheel.WheelError, match="is damaged"):
        wheel.install(path, modules)
    assert (modules / "meniscus" / "__init__.py").read_text() == "Reconstructor = 1"
    assert len(list(modules.iterdir())) == 2
