"""How the programs of a build are started."""

import os


def environment_of_programs():
    """Without what is meant for the tests, or for the interpreter alone: meniscusd takes settings from MENISCUS_..."""
    return {
        name: value for name, value in os.environ.items() if name != "LD_PRELOAD" and not name.startswith("MENISCUS")
    }
