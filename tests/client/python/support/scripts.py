"""Python programs in processes of their own."""

import subprocess
import sys
import textwrap

#: Seconds: what does not end by then hangs.
deadline = 60


def run_script(text, *arguments, flags=()):
    """Runs the program. Returns its exit code, and what it said on both outputs."""
    done = subprocess.run(
        [sys.executable, "-B", *flags, "-c", textwrap.dedent(text), *map(str, arguments)],
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        timeout=deadline,
    )
    return done.returncode, done.stdout, done.stderr
