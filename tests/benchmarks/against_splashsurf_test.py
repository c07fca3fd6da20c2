"""Runs against-splashsurf with simulated frames and a stand-in for splashsurf: against_splashsurf_test.py MENISCUS."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

STAND_IN = """#!/bin/sh
if [ "$1" = --version ]; then echo "splashsurf 0.0.0"; exit; fi
for start in 23:59:59.900 12:00:01.000; do
  echo "[$start][INFO] Starting classification of particles into subdomains."
  end=12:00:01.500
  last=12:00:02.000
  [ "$start" = 12:00:01.000 ] || { end=00:00:00.150; last=$end; }
  echo "[$end][INFO] Global mesh has 4 vertices and 8 triangles."
  echo "[$last][INFO] Writing mesh with 4 vertices and 8 cells to file."
done
"""


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def main():
    meniscus = sys.argv[1]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        stand_in = folder / "splashsurf"
        stand_in.write_text(STAND_IN)
        stand_in.chmod(0o755)
        # 2,000 particles have twice the reference radius; the script takes them for overlapping ones, which serves.
        subprocess.run(
            [meniscus, "simulate", "--particles", "2000", "--frames", "3", "--particles-out", folder], check=True
        )
        for i, name in enumerate(("frame_030", "frame_040", "frame_258")):
            (folder / f"frame_{i:06}.vtk").rename(folder / f"{name}.vtk")
        script = Path(__file__).with_name("against-splashsurf")
        subprocess.run(
            [
                sys.executable,
                script,
                meniscus,
                folder,
                "--splashsurf",
                stand_in,
                "--runs",
                "1",
                "--first-runs",
                "1",
                "--tiles",
                "2",
                "1",
                "--out",
                folder,
            ],
            check=True,
        )
        report = json.loads((folder / "against-splashsurf.json").read_text())
        plain = report["plain"]["frame_040, c = 0.5"]
        check(report["splashsurf"] == "0.0.0", "the version of splashsurf")
        check("cpu" in report["backend"], "the backend")
        check(abs(plain["plain"]["splashsurf_seconds"] - 0.5) < 1e-6, "the warm time of splashsurf")
        check(abs(plain["normals"]["splashsurf_seconds"] - 1.0) < 1e-6, "its warm time with normals")
        check(len(report["plain"]) == 4 and len(report["as_users_see_it"]) == 2, "the comparisons")
        check(all(0.0 < m["triangle_ratio"] <= 1.1 for m in report["modes"].values()), "triangles, adaptive")
        check(report["particles_of_the_large_frame"] == 4000, "particles of the tiled frame")
        check(all(ratio > 0.0 for ratio in report["first_over_warm"].values()), "first frames")
        check(report["memory"]["process_bytes"] > 1e6, "memory")
        check(0.0 < report["share_of_multiply_add_peak"] < 1.0, "the share of the peak")
        check((folder / "against-splashsurf.md").read_text().count("\n") == 21, "rows of the table")


if __name__ == "__main__":
    main()
