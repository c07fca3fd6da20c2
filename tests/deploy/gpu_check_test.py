"""The conclusions that gpu-check draws from the answers of its programs: gpu_check_test.py GPU-CHECK.

The programs are stand-ins whose answers FAKE_* variables set, so that no GPU is needed."""

import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

GPU_CHECK = sys.argv.pop()
FRAMES = 3
SETTINGS = 38  # particles, mode and criterion, field, edge points; and 16-bit positions of both kinds of particles
INSTALLED_SANITIZER = Path("/usr/local/cuda/bin/compute-sanitizer")

MENISCUS = r"""
backend= mode= stats= last=0 command=$1
while [ $# -gt 0 ]; do
  case $1 in --backend) backend=$2 ;; --mode) mode=$2 ;; --stats) stats=$2 ;; --end) last=$2 ;; esac
  shift
done
case $command in
  info)
    [ -z "${FAKE_REFUSAL:-}" ] || { echo "meniscus: the CUDA backend cannot be used: $FAKE_REFUSAL" >&2; exit 2; }
    echo 'version                0.1.0'
    echo "device                 ${FAKE_DEVICE:-Some GPU}"
    ;;
  simulate) echo 'particle radius 0.0125' ;;
  reconstruct)
    {
      echo '{ "frames": ['
      for ((i = 0; i <= last; ++i)); do
        hash=$(printf '%064x' "$i")
        if [ "$backend" = cuda ]; then
          [ "${FAKE_WRONG_FRAME:-}" != "$i$mode" ] || hash=${hash//0/f}
          backend=${FAKE_BACKEND:-cuda}
        fi
        printf '    {\n      "backend": "%s",\n      "mesh_sha256": "%s"\n    }' "$backend" "$hash"
        [ "$i" = "$last" ] || echo ,
      done
      echo '] }'
    } >"$stats"
    ;;
esac
"""

CUDA_TEST = r"""
[ -z "${FAKE_CRASH:-}" ] || kill -SEGV $$
passed=${FAKE_PASSED:-7}
echo "[==========] Running $passed tests from 2 test suites."
echo "[  PASSED  ] $passed tests."
[ -z "${FAKE_SKIPPED:-}" ] || printf '[  SKIPPED ] %s tests, listed below:\n[  SKIPPED ] Cuda.Some\n' "$FAKE_SKIPPED"
[ -n "${FAKE_FAILED:-}" ] || exit 0
printf '[  FAILED  ] %s tests, listed below:\n[  FAILED  ] Cuda.Some\n' "$FAKE_FAILED"
exit 1
"""

MENISCUS_BENCH = r"""
name=$1
while [ $# -gt 0 ]; do [ "$1" != --out ] || out=$2; shift; done
[ "${FAKE_BROKEN_BENCHMARK:-}" != "$name" ] || { echo 'out of "memory"' >&2; exit 1; }
mkdir -p "$out"
if [ "$name" = goals ]; then
  [ -e "$out/scaling.json" ] && measured=7.5 || measured=null
  echo "[{\"goal\": \"8 ms\", \"measured\": $measured}]" >"$out/goals.json"
  exit 0
fi
echo "{\"commit\": \"$MENISCUS_COMMIT\", \"rows\": [1, 2]}" >"$out/$name.json"
"""

NVIDIA_SMI = r"""
[ -z "${FAKE_NO_GPU:-}" ] || { echo 'No devices were found'; exit 6; }
if [ "$1" = -L ]; then
  echo 'GPU 0: Some GPU'
else
  echo 'Some "GPU", 580.1, 81559 MiB, 700.00 W, 345 MHz, 2619 MHz, 1980 MHz, 2619 MHz'
fi
"""

COMPUTE_SANITIZER = r"""
tool=$2
[ "${FAKE_HAZARD:-}" != "$tool" ] || { echo '========= ERROR SUMMARY: 1 error'; exit "$4"; }
shift 4
"$@"
"""


class GpuCheck(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        bundle, self.host = self.folder / "bundle", self.folder / "host"
        (bundle / "bin").mkdir(parents=True)
        self.host.mkdir()
        self.script = shutil.copy(GPU_CHECK, bundle)
        (bundle / "VERSION").write_text("meniscus 0.1.0\ncommit 0123456789ab\n")
        for path, body in (
            (bundle / "bin/meniscus", MENISCUS),
            (bundle / "bin/cuda_test", CUDA_TEST),
            (bundle / "bin/meniscus-bench", MENISCUS_BENCH),
            (self.host / "nvidia-smi", NVIDIA_SMI),
            (self.host / "compute-sanitizer", COMPUTE_SANITIZER),
        ):
            path.write_text("#!/usr/bin/env bash\n" + body)
            path.chmod(0o755)

    def run_script(self, *arguments, **fakes):
        """Returns exit code, output and, where there are some, results."""
        environment = {
            "PATH": f"{self.host}:/usr/bin:/bin",
            **{f"FAKE_{name.upper()}": str(value) for name, value in fakes.items()},
        }
        results = self.folder / "results"
        done = subprocess.run(
            [self.script, "--out", results, "--frames", str(FRAMES), *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            check=False,
        )
        written = results / "results.json"
        return done.returncode, done.stdout, json.loads(written.read_text()) if written.exists() else None

    def assert_fails(self, step, *arguments, **fakes):
        """Runs it and returns the one kind of step that has failed."""
        code, _, results = self.run_script(*arguments, **fakes)
        self.assertEqual((code, results["result"]), (1, "failed"))
        failed = [s for s in results["steps"] if s["result"] == "failed"]
        self.assertEqual({s["name"].split(",")[0] for s in failed}, {step})
        return failed[0]

    def test_passes_where_everything_does(self):
        code, _, results = self.run_script()
        self.assertEqual((code, results["result"]), (0, "passed"))
        names = [s["name"].split(",")[0] for s in results["steps"]]
        self.assertEqual(
            names,
            [
                "gpu",
                "tests",
                *["hashes"] * SETTINGS,
                "memcheck",
                "racecheck",
                "initcheck",
                "synccheck",
                "thousand-frames",
                "experiment",
                "scaling",
            ],
        )
        self.assertTrue(
            all(s["result"] == "passed" and s["failed"] == 0 and s["skipped"] == 0 for s in results["steps"])
        )
        counts = {s["name"].split(",")[0]: s["passed"] for s in results["steps"]}
        self.assertEqual((counts["tests"], counts["hashes"]), (7, FRAMES))
        self.assertEqual(len({s["name"] for s in results["steps"]}), len(results["steps"]))

    def test_tells_what_was_proven_on_what(self):
        _, _, results = self.run_script("tests")
        self.assertEqual(
            (results["version"], results["commit"], results["device"]), ("0.1.0", "0123456789ab", "Some GPU")
        )
        gpu = results["gpus"][0]
        self.assertEqual(
            (gpu["name"], gpu["driver_version"], gpu["clocks_max_sm"]), ('Some "GPU"', "580.1", "1980 MHz")
        )
        self.assertTrue(results["machine"]["processor"])

    def test_embeds_the_benchmarks(self):
        _, _, results = self.run_script("benchmark")
        self.assertEqual(
            results["benchmarks"], dict.fromkeys(("experiment", "scaling"), {"commit": "0123456789ab", "rows": [1, 2]})
        )

    def test_has_a_row_for_every_goal_measured_or_not(self):
        for arguments, fakes, measured in (
            (["tests"], {}, None),
            (["benchmark"], {}, 7.5),
            ([], {"refusal": "none", "no_gpu": 1}, None),
        ):
            _, _, results = self.run_script(*arguments, **fakes)
            self.assertEqual(results["goals"], [{"goal": "8 ms", "measured": measured}], arguments)

    def test_goals_that_cannot_be_judged_are_a_failure(self):
        self.assert_fails("goals", "tests", broken_benchmark="goals")

    def test_without_a_gpu_has_its_own_exit_code(self):
        code, output, results = self.run_script(refusal='no "driver"', no_gpu=1)
        self.assertEqual((code, results["result"], results["steps"]), (77, "no GPU", []))
        self.assertEqual(output.count("\n"), 1)
        self.assertIn('no "driver"', output)

    def test_a_gpu_that_cannot_be_used_is_a_failure(self):
        self.assertIn("driver too old", self.assert_fails("gpu", refusal="driver too old")["detail"])

    def test_a_skipped_test_is_a_failure(self):
        self.assertEqual(self.assert_fails("tests", "tests", skipped=2)["skipped"], 2)

    def test_no_test_at_all_is_a_failure(self):
        self.assert_fails("thousand-frames", "thousand-frames", passed=0)

    def test_a_failed_test_is_counted(self):
        self.assertEqual(self.assert_fails("tests", "tests", failed=3)["failed"], 3)

    def test_a_crash_is_a_failure(self):
        self.assertIn("exit code", self.assert_fails("tests", "tests", crash=1)["detail"])

    def test_a_different_mesh_is_named(self):
        step = self.assert_fails("hashes", "hashes", wrong_frame="2uniform")
        self.assertIn("--mode uniform", step["command"])
        self.assertEqual((step["detail"], step["passed"], step["failed"]), ("frame 2 differs", FRAMES - 1, 1))

    def test_frames_that_another_backend_reconstructed_prove_nothing(self):
        self.assert_fails("hashes", "hashes", backend="cpu")

    def test_a_hazard_is_a_failure(self):
        self.assert_fails("racecheck", "sanitizers", hazard="racecheck")

    @unittest.skipIf(INSTALLED_SANITIZER.exists(), f"{INSTALLED_SANITIZER} is installed")
    def test_a_missing_sanitizer_is_recorded(self):
        (self.host / "compute-sanitizer").unlink()
        code, _, results = self.run_script("sanitizers")
        self.assertEqual(code, 0)
        self.assertEqual([s["result"] for s in results["steps"]], ["passed", *["not run"] * 4])

    def test_without_nvidia_smi_its_figures_are_not_known(self):
        (self.host / "nvidia-smi").unlink()
        code, _, results = self.run_script("tests")
        self.assertEqual((code, results["gpus"]), (0, "not known"))

    def test_a_broken_benchmark_is_a_failure(self):
        step = self.assert_fails("scaling", "benchmark", broken_benchmark="scaling")
        self.assertIn('out of "memory"', step["detail"])

    def test_any_name_makes_valid_results(self):
        _, _, results = self.run_script("tests", device='"\\\t\x01 é')
        self.assertEqual(results["device"], '"\\?? ??')

    def test_refuses_wrong_arguments(self):
        for arguments in (["levitate"], ["--frames", "0"], ["--out"]):
            code, output, _ = self.run_script(*arguments)
            self.assertEqual((code, output.count("\n")), (2, 1), arguments)


if __name__ == "__main__":
    unittest.main()
