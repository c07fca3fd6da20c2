"""What mypy says of the package's types: check_types.py SCRATCH

Stubs name every keyword, and hide the modules beside them, which are checked without them. Of wrong_calls.py each line
that is marked is refused and no other, of right_calls.py none.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

here = Path(__file__).resolve().parent
client = here.parents[3] / "client" / "python"
scratch = Path(sys.argv[1])
least = 20


def refused(*what, folder=client):
    """The errors that mypy finds, one line each."""
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--hide-error-context"]
    ran = subprocess.run(
        [*command, "--cache-dir", scratch / f"mypy_of_{folder.name}", *what], cwd=folder, capture_output=True, text=True
    )
    assert ran.returncode in (0, 1), ran.stdout + ran.stderr
    return [line for line in ran.stdout.splitlines() if ": error: " in line]


def sources_without_stubs():
    copy = scratch / "sources" / "meniscus"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(client / "meniscus", copy, ignore=shutil.ignore_patterns("__pycache__"))
    for stub in copy.glob("*.pyi"):
        if stub.with_suffix(".py").exists():
            stub.unlink()
    return copy.parent


def marked(file):
    return {number for number, line in enumerate(file.read_text().splitlines(), 1) if line.endswith("# wrong")}


def found(file):
    return {int(re.search(rf"{file.name}:(\d+): error", line)[1]) for line in refused(file)}


wrong, right = here / "wrong_calls.py", here / "right_calls.py"
assert len(marked(wrong)) >= least
assert found(wrong) == marked(wrong), f"lines {sorted(found(wrong) ^ marked(wrong))} of {wrong.name} are not as marked"
assert not (errors := refused(right)), errors
assert not (errors := refused("-p", "meniscus", folder=sources_without_stubs())), errors
