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
            [meniscus, "simulate", "--particles", "2000", "--frames", "2", "--particles-out", folder], check=True
        )
        (folder / "frame_000000.vtk").rename(folder / "frame_040.vtk")
        (folder / "frame_000001.vtk").rename(folder / "frame_258.vtk")
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
                "--tiles",
                "2",
                "1",
                "--out",
                folder,
            ],
            check=True,
        )
        report = json.loads((folder / "against-splashsurf.json").read_text())
        speed, frame, large = report["frame_040_speed"], report["frame_040"], report["large"]
        check(report["splashsurf"] == "0.0.0", "the version of splashsurf")
        check(abs(speed["splashsurf_seconds"] - 0.5) < 1e-6, "the warm time of splashsurf")
        check(abs(speed["splashsurf_normals_seconds"] - 1.0) < 1e-6, "its warm time with normals")
        check(0.0 < frame["adaptive_triangles"] <= frame["uniform_triangles"] * 1.1, "triangles of frame 040")
        check(large["particles"] == 4000, "particles of the tiled frame")
        check(large["uniform_process_bytes"] > 1e6, "memory")
        check((folder / "against-splashsurf.md").read_text().count("\n") == 9, "rows of the table")


if __name__ == "__main__":
    main()
