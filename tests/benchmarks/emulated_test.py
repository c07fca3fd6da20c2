#!/usr/bin/env python3
"""The commands for a GPU on the device in software: emulated_test.py BENCH BENCH_EMULATED [SANITIZER].

SANITIZER: one that is compiled in. Two steps of `check` then outlast their limits; `kernels` runs them by itself."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def run(program, *words, expect=0):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)
    check(done.returncode == expect, f"{words} ends with {done.returncode}, should be {expect}:\n{done.stderr}")
    return done


def rows_of(folder, name):
    with open(folder / f"{name}.csv", newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


def check_same(bench, folder):
    done = run(bench, "same", "--particles", 300, "--cell-sizes", 1, "--fields", "smooth", "--modes", "adaptive",
               "--waters", "splashing", "--replays", 2, "--threads", 2, "--out", folder)  # fmt: skip
    rows = rows_of(folder, "same")
    check(len(rows) == 5 + 2, f"same: {len(rows)} rows")
    check(all(r["result"] == "same" and int(r["triangles"]) > 100 for r in rows), f"same: {rows}")
    replayed = [r["run"] for r in rows if r["run"].endswith("(graph)")]
    check(len(replayed) >= 2, f"same: frames that were replayed as graphs are {replayed}")
    check(any(int(r["spray"]) > 0 for r in rows), "same: no case lists spray")
    check(done.stdout.splitlines()[1].startswith("300,splashing,smooth,adaptive,1.0,frame 1,same"), done.stdout)

    run(bench, "same", "--particles", 100, "--modes", "uniform", "--fields", "color", "--budget", 1e-6, "--threads", 1,
        "--replays", 0, "--out", folder)  # fmt: skip
    first, *rest = [r["result"] for r in rows_of(folder, "same") if r["run"] in ("all", "frame 1")]
    check((first, set(rest)) == ("same", {"left_out"}), "same: the budget leaves out what comes after the first case")
    for words, name in ((["--fields", "wool"], "wool"), (["--particles", "0"], "0")):
        check(name in run(bench, "same", *words, "--out", folder, expect=2).stderr, f"same: {words} is not named")


def check_exact(bench, folder):
    run(bench, "exact", "--roots", 4096, "--quotients", 3000, "--elements", 4097, "--out", folder)
    rows = rows_of(folder, "exact")
    check(all(r["result"] == "same" for r in rows), f"exact: {rows}")
    sizes = {r["n"] for r in rows if r["check"].startswith("sort by ") and r["run"] == "replay"}
    check(sizes == {"0", "1", "31", "256", "4097"}, f"exact: sorts of {sizes}")
    checks = {r["check"] for r in rows}
    check(
        {"root", "reciprocal", "quotient", "fused", "sort_pairs by 64 bits", "sum of 16 bytes"} <= checks,
        f"exact: {checks}",
    )
    run(bench, "exact", "--roots", 3, "--out", folder, expect=2)


def check_kernels(bench, folder):
    run(bench, "kernels", "--particles", 300, "--mode", "adaptive", "--repeats", 2, "--out", folder)
    rows = rows_of(folder, "kernels")
    names = [r["kernel"] for r in rows]
    for name in ("sample_list<ParticleField<Poly6>>", "balance_and_promote", "emit_cells"):
        check(name in names, f"kernels: {name} is not among {names}")
    check(any(n.startswith("CUB sort of ") for n in names), "kernels: no sort")
    check(names[-4:] == ["launches", "frame", "graph", "gaps"], f"kernels: the sums are {names[-4:]}")
    launches = [r for r in rows if r["blocks"]]
    check(len(launches) > 30 and all(int(r["blocks"]) > 0 for r in launches), "kernels: a launch without blocks")
    check({r["kernel"].split("<")[0] for r in launches if r["cooperative"] == "true"}
          == {"balance_and_promote", "settle_band"}, "kernels: the cooperative ones")  # fmt: skip
    check("write_bricks" not in names, "kernels: bricks are packed unasked")
    report = json.loads((folder / "kernels.json").read_text())
    check(report["commit"] and len(report["rows"]) == len(rows), "kernels: the JSON")
    run(bench, "kernels", "--packed", "--particles", 300, "--repeats", 2, "--out", folder)
    names = {r["kernel"] for r in rows_of(folder, "kernels")}
    check({"keep_bricks", "write_bricks", "sum_words"} <= names, f"kernels --packed: {names}")


def check_transfers(bench, folder):
    run(bench, "transfers", "--bytes", 1 << 20, "--repeats", 2, "--out", folder)
    rows = rows_of(folder, "transfers")
    whats = [r["what"] for r in rows]
    check(whats == ["first touch", *["up pageable"] * 2, *["down pageable"] * 2, "pin", *["up pinned"] * 2,
                    *["down pinned"] * 2, "unpin"], f"transfers: {whats}")  # fmt: skip
    check(all(float(r["seconds"]) > 0 for r in rows), "transfers: a time")


def results_of(folder):
    """The rows in the one file that comes home."""
    with tarfile.open(folder.with_name(folder.name + ".tar.gz")) as archive:
        text = archive.extractfile("check.csv").read().decode()
        names = archive.getnames()
    return list(csv.DictReader(text.splitlines())), names


def program(folder, name, script):
    path = folder / name
    path.write_text("#!/bin/sh\n" + script)
    path.chmod(0o755)


def check_check(bench, folder, is_sanitized):
    steps = [line.split()[0] for line in run(bench, "check", "--particles", 640, "--list").stdout.splitlines()]
    check(steps[:2] == ["device", "transfers"] and steps[-1] == "same-rest", f"check: steps are {steps}")
    # The sizes of a GPU take too long here.
    slow = ("exact", "kernels-uniform", "kernels-adaptive", "kernels-packed-adaptive", "same-large", "same-threads",
            "same-rest")  # fmt: skip
    passed = {"transfers", "same-small", "same-million"}
    timed = {"kernels-packed", "kernels-small"}
    if is_sanitized:
        slow += tuple(timed)
    else:
        passed |= timed
    out = folder / "whole"
    run(bench, "check", "--particles", 640, "--out", out, "--only",
        *[step for step in steps if step not in slow])  # fmt: skip
    rows, names = results_of(out)
    results = {r["step"]: r["result"] for r in rows}
    check({s for s in results if results[s] == "passed"} >= passed, f"check: {rows}")
    check(results["delivery"] == "not run" and results["tests"] == "not run", f"check: {rows}")
    check({"check.csv", "check.json", "same-small.log", "same-small/same.csv"} <= set(names), f"check: has {names}")

    # The last step takes the rest of the time.
    run(bench, "check", "--only", "same-rest", "--seconds", 3, "--out", folder / "rest")
    rows, _ = results_of(folder / "rest")
    check([r["result"] for r in rows] == ["cut off"], f"check: {rows}")

    # A step that fails runs in two other ways; the program is found in PATH.
    beside = folder / "beside"
    beside.mkdir()
    environment = {**os.environ, "PATH": f"{beside}:{os.environ['PATH']}"}
    words = [bench, "check", "--only", "tests", "--out"]
    program(beside, "cuda_test", '[ "$MENISCUS_COOPERATIVE_BLOCKS" = 1 ] || { echo out of step; exit 3; }\n')
    done = subprocess.run([*words, folder / "failing"], env=environment, capture_output=True, text=True, check=False)
    rows, _ = results_of(folder / "failing")
    ways = [(r["way"], r["result"], r["exit_code"], r["detail"]) for r in rows]
    expected = [
        ("", "failed", "3", "out of step"),
        ("MENISCUS_NO_GRAPH=1", "failed", "3", "out of step"),
        ("MENISCUS_COOPERATIVE_BLOCKS=1", "passed", "0", ""),
    ]
    check(done.returncode == 1 and ways == expected, f"check: {ways}")

    # Told to end, it ends its child, and leaves its results, also if it is told once more while it packs them.
    began = folder / "began"
    os.mkfifo(began)
    program(beside, "cuda_test", f"echo $$ >{began}\nexec sleep 600\n")
    program(beside, "tar", f'kill -TERM $PPID\nexec {shutil.which("tar")} "$@"\n')
    words.append(folder / "ended")
    with subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
        process = began.read_text().strip()
        running.send_signal(signal.SIGTERM)
        running.wait()
    rows, _ = results_of(folder / "ended")
    check([(r["way"], r["result"]) for r in rows][0] == ("", "cut off"), f"check: {rows}")
    check(not Path(f"/proc/{process}").exists(), "check: what it has started goes on")
    check(
        "no-step" in run(bench, "check", "--only", "no-step", "--out", folder / "none", expect=2).stderr,
        "check: --only",
    )


def main():
    bench, emulated, *sanitized = sys.argv[1:]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        check_same(emulated, folder)
        check_exact(emulated, folder)
        check_kernels(emulated, folder)
        check_transfers(emulated, folder)
        check_check(emulated, folder, bool(sanitized))
        if shutil.which("nvidia-smi"):
            return
        for command in ("same", "exact", "kernels", "transfers", "check"):
            check("GPU" in run(bench, command, expect=77).stderr, f"{command}: says why it does not run")


if __name__ == "__main__":
    main()
