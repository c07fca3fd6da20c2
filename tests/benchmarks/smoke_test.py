"""Runs every subcommand of meniscus-bench at a tiny size: smoke_test.py MENISCUS-BENCH MENISCUSD."""

import csv
import hashlib
import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path

RUNS = {
    "experiment": (["--frames", "3", "--particles", "500"], 6),
    "scaling": (
        ["--max-particles", "20000", "--fields", "smooth", "color", "--cell-sizes", "1", "--repeats", "1"],
        8,
    ),
    "encoding": (["--particles", "16000", "--cell-size", "1.0", "--repeats", "1"], 16),
}


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def read_rows(folder, name):
    with open(folder / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def check_goals(bench):
    """Nothing is measured without results of a GPU; with some, each figure is that of its row."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)

        def goals():
            subprocess.run([bench, "goals", "--out", folder], check=True, capture_output=True)
            return json.loads((folder / "goals.json").read_text())

        check(
            [(g["measured"], g["holds"]) for g in goals()] == [(None, None)] * 8,
            "goals: something is measured without results",
        )
        cases = (
            ("splashing", "smooth", "uniform"),
            ("splashing", "smooth", "adaptive"),
            ("splashing", "color", "uniform"),
            ("splashing", "color", "adaptive"),
            ("calm", "smooth", "uniform"),
            ("calm", "smooth", "adaptive"),
        )
        scaling = [
            {
                "water": water,
                "field": field,
                "mode": mode,
                "cell_size": 1.0,
                "particles": 64 * 16000,
                "reconstruction_seconds": 0.001 * (10 + i),
                "device_peak_bytes": 100 * (i + 1),
            }
            for i, (water, field, mode) in enumerate(cases)
        ]
        experiment = [{"mode": "adaptive", "reconstruction_seconds": s} for s in (0.0007, 0.0001, 0.0004)]
        for backend in ("cpu", "cuda"):
            for name, rows in (("scaling", scaling), ("experiment", experiment)):
                (folder / f"{name}.json").write_text(json.dumps({"backend": backend, "rows": rows}))
            (folder / "splashsurf.json").write_text('{"seconds": 0.72}')
            found = [(g["measured"] and round(g["measured"], 3), g["holds"]) for g in goals()]
            expected = [
                (10.0, True),
                (11.0, False),
                (12.0, False),
                (13.0, False),
                (0.4, True),
                (0.933, False),
                (1.2, False),
                (60.0, True),
            ]
            check(found == (expected if backend == "cuda" else [(None, None)] * 8), f"goals: {backend} gives {found}")


def check_service(bench, meniscusd, folder):
    """Serving frames takes at least the processor time of reconstructing and encoding them.

    The error names a server that is not there."""
    tiny = ["--particles", "16000", "--frames", "3", "--repeats", "1", "--out", folder]
    subprocess.run([bench, "service", "--meniscusd", meniscusd, *tiny], check=True)
    rows = read_rows(folder, "service")
    check([row["codec"] for row in rows] == ["draco", "packed", "entropy"], f"service: {rows}")
    for row in rows:
        check(float(row["here_processor_seconds"]) > 0 and float(row["served_over_here"]) > 0.5, f"service: {row}")
    missing = subprocess.run(
        [bench, "service", "--meniscusd", folder / "nowhere", *tiny], capture_output=True, text=True
    )
    check(missing.returncode == 1 and "nowhere" in missing.stderr, f"service: a missing program gives {missing}")


def check_delivery(bench, meniscusd, folder):
    """Each codec brings the same surface to the watcher, in a time that holds that of its reconstruction."""
    subprocess.run(
        [bench, "delivery", "--meniscusd", meniscusd, "--particles", "4000", "--frames", "3", "--out", folder],
        check=True,
    )
    rows = {row["codec"]: row for row in read_rows(folder, "delivery")}
    check(list(rows) == ["packed", "entropy", "draco"], f"delivery: {rows}")
    for row in rows.values():
        seconds = {name: float(row[f"{name}_seconds"]) for name in ("first", "median", "least", "reconstruction")}
        check(0 < seconds["reconstruction"] < seconds["median"], f"delivery: {row}")
        check(0 < seconds["least"] <= seconds["median"] and seconds["first"] > 0, f"delivery: {row}")
        check(int(row["triangles"]) > 1000 and int(row["particles"]) == 4000, f"delivery: {row}")
    check(len({row["triangles"] for row in rows.values()}) == 1, f"delivery: other surfaces: {rows}")
    check(int(rows["entropy"]["bytes"]) < int(rows["packed"]["bytes"]), f"delivery: {rows}")


def check_pushing(bench, folder):
    """Each deal has a row with one rank that makes parts, and one with all."""
    subprocess.run(
        [bench, "pushing", "--ranks", "2", "--particles", "8000", "--frames", "2", "--out", folder], check=True
    )
    rows = read_rows(folder, "pushing")
    makers = [(row["deal"], row["makers"]) for row in rows]
    check(makers == [(deal, count) for deal in ("slabs", "at random") for count in "12"], f"pushing: {makers}")
    check(all(float(row["least_over_a_copy"]) > 1 for row in rows), f"pushing: cheaper than a copy: {rows}")


def check_quality(bench, folder):
    """The plain field has the figures that are known for it; wrong input is refused; the page can be written."""
    few = ["--shapes", "drops", "--field", "color", "--mode", "uniform", "--out", folder]
    quality = [bench, "quality", *few]
    subprocess.run([*quality, "--parts", "shapes", "groups", "--cell-size", "0.25"], check=True)
    rows = read_rows(folder, "quality")

    def figure(subject, sampling, name):
        (row,) = [r for r in rows if (r["subject"], r["sampling"], r["figure"]) == (subject, sampling, name)]
        return float(row["value"])

    volumes = {"one": 0.98, "two at 2 r": 1.02, "three in one place": 0.33, "cube of 8 at 1.6 r": 0.55}
    for group, volume in volumes.items():
        found = figure(group, "", "volume")
        check(abs(found - volume) < 0.006, f"quality: the volume of {group} is {found}, should be {volume}")
        check(figure(group, "", "lost_particles") == 0, f"quality: particles of {group} are lost")
    for sampling in ("jittered", "rotated", "relaxed"):
        check(figure("drops", sampling, "components") == 2, f"quality: {sampling} drops are joined")
        check(0.8 < figure("drops", sampling, "volume") < 1.1, f"quality: {sampling} drops have a wrong volume")

    particles = folder / "particles"
    subprocess.run([*quality, "--parts", "shapes", "--write-particles", particles], check=True)
    check(len(list(particles.glob("drops-*.vtk"))) == 3, "quality: one file of particles for each sampling")
    for options, name in ((["--shapes", "cone"], "cone"), (["--parts", "taste"], "taste"), (["--judge", "x"], "x")):
        refused = subprocess.run([bench, "quality", *options], capture_output=True, text=True)
        check(refused.returncode == 2 and name in refused.stderr, f"quality: {options} gives {refused}")

    figures = Path(__file__).with_name("quality-figures")
    subprocess.run([sys.executable, figures, bench, "--parts", "groups", "--out", folder], check=True)
    check("0 lost" in (folder / "quality.md").read_text(), "quality: the page has no lone groups")


def check_codecs(bench, frame, folder):
    """Each codec has its row for each mode; tables come with the hash of their frames, which need a radius."""
    few = ["--rounds", "1", "--normal-bits", "8", "--sections", "--receiver-normals", "--out", folder]
    printed = subprocess.run([bench, "codecs", frame, *few], check=True, stdout=subprocess.PIPE, text=True).stdout
    check(
        printed.count("degrees off (median)") == 2, f"codecs: no error of a receiver's normals for each mode: {printed}"
    )
    rows = [(row["mode"], row["codec"]) for row in read_rows(folder, "codecs")]
    expected = [(mode, codec) for mode in ("adaptive", "uniform") for codec in ("draco", "packed", "entropy")]
    check(rows == expected, f"codecs: {rows}")
    tables = folder / "tables"
    tables.mkdir()
    subprocess.run([bench, "lattice-tables", f"{frame}@0.025", "--out", tables], check=True)
    found = hashlib.sha256(frame.read_bytes()).hexdigest()
    check(found in (tables / "frames.txt").read_text(), "lattice-tables: no hash of the frame")
    refused = subprocess.run([bench, "lattice-tables", frame, "--out", tables], capture_output=True, text=True)
    check(refused.returncode == 2 and "FILE@RADIUS" in refused.stderr, f"lattice-tables: no radius gives {refused}")


def main():
    bench = sys.argv[1]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for name, (options, rows) in RUNS.items():
            subprocess.run([bench, name, *options, "--out", folder], check=True)
            table = read_rows(folder, name)
            check(len(table) == rows, f"{name}: {len(table)} rows, should be {rows}")
            check(all(int(row["triangles"]) > 0 for row in table), f"{name}: a row without triangles")
            report = json.loads((folder / f"{name}.json").read_text())
            check(len(report["rows"]) == rows, f"{name}: the JSON has other rows than the CSV")
            for key in ("machine", "commit", "command"):
                check(report[key], f"{name}: the JSON has no {key}")
        check(
            all(float(row["total_seconds"]) > 0 for row in read_rows(folder, "experiment")), "experiment: a time of 0"
        )
        plots = sorted(folder.glob("experiment-*.svg"))
        check(len(plots) == 4, f"experiment: {len(plots)} plots, should be 4")
        lines = [len(xml.etree.ElementTree.parse(p).findall("{http://www.w3.org/2000/svg}polyline")) for p in plots]
        check(lines == [2, 2, 8, 4], f"experiment: lines in the plots are {lines}")
        check_service(bench, sys.argv[2], folder)
        check_delivery(bench, sys.argv[2], folder)
        check_pushing(bench, folder)
        check_quality(bench, folder)
        check_codecs(bench, min((folder / "particles").glob("*.vtk")), folder)
    check_goals(bench)
    check(
        subprocess.run([bench, "encoding", "--water", "ice"], capture_output=True).returncode == 2,
        "wrong input is refused",
    )
    none = subprocess.run(
        [bench, "scaling", "--min-particles", "64000", "--max-particles", "16000"], capture_output=True, text=True
    )
    check(none.returncode == 2 and "64000" in none.stderr, f"scaling: sizes without any between them give {none}")
    for name in ("experiment", "scaling"):
        refused = subprocess.run([bench, name, "--backend", "abacus"], capture_output=True, text=True)
        check(refused.returncode == 2 and "abacus" in refused.stderr, f"{name}: a wrong backend is refused by its name")


if __name__ == "__main__":
    main()
