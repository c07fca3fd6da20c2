"""Runs against-build with stand-ins for builds, and its measurements with a real one: against_build_test.py BUILD."""

import json
import subprocess
import sys
import tempfile
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import SimpleNamespace

SCRIPT = Path(__file__).with_name("against-build")

STAND_IN = """#!/bin/sh
command=$1
while [ $# -gt 0 ]; do
  case $1 in --stats) stats=$2 ;; --out) out=$2 ;; esac
  shift
done
if [ "$command" = reconstruct ]; then
  echo '{"total_seconds": SECONDS}' >"$stats"
else
  echo '{"rows": [{"frame": 1, "mode": "uniform", "total_seconds": SECONDS},
                  {"frame": 1, "mode": "adaptive", "total_seconds": 0.01}]}' >"$out/experiment.json"
fi
"""


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def load(path):
    """A script without an extension, as a module."""
    sys.dont_write_bytecode = True
    spec = spec_from_loader(path.name, SourceFileLoader(path.name, str(path)))
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check_intervals(script):
    def ranks(count):
        return script.median_interval(list(range(count, 0, -1)))

    check(ranks(6) == (1, 6), "of six values the whole range: 1 - 2 / 2^6 = 0.969")
    check(ranks(8) == (1, 8), "of eight values, too: without the outer two 0.930")
    check(ranks(15) == (4, 12), "of 15 values the fourth from both ends: 0.965")
    check(ranks(20) == (6, 15), "of 20 values the sixth from both ends: 0.959")


def make_build(folder, frame_seconds, experiment_seconds):
    for program, seconds in (
        ("client/cli/meniscus", frame_seconds),
        ("tests/benchmarks/meniscus-bench", experiment_seconds),
    ):
        path = folder / program
        path.parent.mkdir(parents=True)
        path.write_text(STAND_IN.replace("SECONDS", str(seconds)))
        path.chmod(0o755)
    return folder


def check_verdicts(folder):
    def compare(old, new, *options):
        """Exit code and report."""
        command = [sys.executable, SCRIPT, old, new, folder, "--out", folder, *options]
        code = subprocess.run(command, check=False).returncode
        return code, json.loads((folder / "against-build.json").read_text())

    old = make_build(folder / "old", 0.02, 0.01)
    code, report = compare(old, make_build(folder / "similar", 0.0202, 0.005), "--pairs", "7")
    check(code == 0 and report["slower"] == [], "one percent more is below the limit")
    check(len(report["rows"]) == 10, "rows: two frames, two cell sizes, two modes; the experiment's two modes")
    check(all(len(row["pairs"]) == 7 for row in report["rows"]), "seven pairs of each row")
    ratios = [round(row["ratio"], 9) for row in report["rows"]]
    check(ratios == 8 * [1.01] + [0.5, 1.0], "ratios are new / old, whichever began")

    code, report = compare(old, make_build(folder / "slower", 0.02, 0.0105), "--pairs", "6")
    check(code == 1, "five percent more is a failure")
    check(report["slower"] == ["experiment, frame 1, uniform, c = 0.5"], "only that row")
    check((folder / "against-build.md").read_text().count("slower") == 1, "its mark in the table")


def check_measurements(script, build, folder):
    meniscus = build / "client/cli/meniscus"
    command = [meniscus, "simulate", "--particles", "500", "--frames", "1", "--particles-out", folder]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    for mode in script.MODES:
        seconds = script.measure_frame(build, folder / "frame_000000.vtk", mode, "1.0", 2)
        check(list(seconds) == [f"frame_000000, {mode}, c = 1.0"], "a row of a frame")
        check(all(value > 0.0 for value in seconds.values()), "its time")
    arguments = SimpleNamespace(particles=500, experiment_frames=2, experiment_repeats=1)
    seconds = script.measure_experiment(build, arguments)
    check(len(seconds) == 4 and all(value > 0.0 for value in seconds.values()), "rows of the experiment")


def check_service_measurements(script, build):
    rows = script.measure_load_example(build, 2)
    check(len(rows) == 3 and all(value > 0.0 for value in rows.values()), "latencies of the load example")
    check(
        all(value > 0.0 for value in script.measure_throughput(build, 1).values()), "the time of a frame at full rate"
    )


def main():
    build = Path(sys.argv[1])
    script = load(SCRIPT)
    check_intervals(script)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for name in script.FRAMES:
            (folder / f"{name}.vtk").touch()
        check_verdicts(folder)
        check_measurements(script, build, folder)
    check_service_measurements(script, build)


if __name__ == "__main__":
    main()
