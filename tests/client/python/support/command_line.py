"""The program meniscus, which says what the package has to give."""

import json
import os
import subprocess

from .programs import environment_of_programs

program = os.environ.get("MENISCUS_CLI", "")


def meniscus(*arguments):
    done = subprocess.run(
        [program, *map(str, arguments)], capture_output=True, text=True, env=environment_of_programs(), timeout=60
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def reconstructed(particles, mesh, radius, *flags):
    """Reconstructs a file into another. Returns the frame's statistics."""
    figures = f"{mesh}.json"
    meniscus("reconstruct", particles, "-o", mesh, "-r", radius, "--stats", figures, *flags)
    with open(figures) as file:
        content = json.load(file)
    return content["frames"][0] if "frames" in content else content
