"""The program meniscus, which says what the package has to give."""

import json
import os
import subprocess

from .programs import environment_of_programs

program = os.environ.get("MENISCUS_CLI", "")


def _ran(*arguments):
    return subprocess.run(
        [program, *map(str, arguments)], capture_output=True, text=True, env=environment_of_programs(), timeout=60
    )


def meniscus(*arguments):
    done = _ran(*arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def said_beside(*arguments):
    """The warnings of a call that succeeds."""
    done = _ran(*arguments)
    assert done.returncode == 0, done.stderr
    return done.stderr


def reconstructed(particles, mesh, radius, *flags):
    """Reconstructs a file into another. Returns the frame's statistics."""
    figures = f"{mesh}.json"
    meniscus("reconstruct", particles, "-o", mesh, "-r", radius, "--stats", figures, *flags)
    with open(figures) as file:
        content = json.load(file)
    return content["frames"][0] if "frames" in content else content


def failed(*arguments):
    """The error of a call that is refused."""
    done = _ran(*arguments)
    assert done.returncode != 0, done.stdout
    return done.stderr
