"""What goes into a wheel, and what its making needs; no extension is built here."""

import os
import pathlib
import subprocess
import sys

import pytest

client = pathlib.Path(__file__).parents[3] / "client" / "python"


def set_up(*arguments, **options):
    pytest.importorskip("setuptools", minversion="61")
    return subprocess.run(
        [sys.executable, "-B", "setup.py", "-q", *map(str, arguments)],
        cwd=client,
        capture_output=True,
        text=True,
        timeout=60,
        **options,
    )


def test_a_wheel_has_every_module_its_stubs_and_the_mark_of_types(tmp_path):
    ran = set_up("build_py", "--build-lib", tmp_path)
    assert ran.returncode == 0, ran.stderr
    packed = {path.name for path in (tmp_path / "meniscus").iterdir()}
    assert packed == {path.name for path in (client / "meniscus").iterdir() if path.is_file()}
    assert {"py.typed", "client.pyi", "_meniscus.pyi"} <= packed


def test_a_wheel_without_its_tools_says_so_in_one_sentence_and_builds_nothing(tmp_path):
    ran = set_up("build_ext", "--build-lib", tmp_path, env={**os.environ, "PATH": str(tmp_path), "BUILT_MENISCUS": "/"})
    assert ran.returncode != 0
    lines = ran.stderr.splitlines()
    assert lines[-1] == "setup.py: the wheel needs patchelf and strip: run deploy/install-packages wheel"
    assert "Traceback" not in ran.stderr and not list(tmp_path.iterdir())
