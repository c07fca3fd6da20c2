"""The conclusions that gpu-check draws from the answers of its programs: gpu_check_test.py GPU-CHECK.

The programs are stand-ins whose answers FAKE_* variables set, so that no GPU is needed."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import gpu_check_stand_ins as stand_ins

GPU_CHECK = sys.argv.pop()
FRAMES = 3
SETTINGS = 38  # particles, mode and criterion, field, edge points; and 16-bit positions of both kinds of particles
INSTALLED_SANITIZER = Path("/usr/local/cuda/bin/compute-sanitizer")

FIRST = ["tests", "same", "exact", "times", "experiment"]
FIRST += ["kernels"] * 4 + ["profile", "same-large", "memcheck", "racecheck", "synccheck", "same-threads"]


class GpuCheck(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        bundle, self.host = self.folder / "bundle", self.folder / "host"
        (bundle / "bin").mkdir(parents=True)
        self.host.mkdir()
        self.script = shutil.copy(GPU_CHECK, bundle)
        shutil.copytree(GPU_CHECK + "-parts", bundle / "gpu-check-parts")
        (bundle / "VERSION").write_text("meniscus 0.1.0\ncommit 0123456789ab\n")
        self.results = self.folder / "results"
        for path, body in (
            (bundle / "bin/meniscus", stand_ins.MENISCUS),
            (bundle / "bin/cuda_test", stand_ins.CUDA_TEST),
            (bundle / "bin/meniscus-bench", stand_ins.MENISCUS_BENCH),
            (bundle / "bin/meniscusd", stand_ins.MENISCUSD),
            (bundle / "bin/meniscus-load", stand_ins.MENISCUS_LOAD),
            (self.host / "splashsurf", stand_ins.SPLASHSURF),
            (self.host / "nvidia-smi", stand_ins.NVIDIA_SMI),
            (self.host / "compute-sanitizer", stand_ins.COMPUTE_SANITIZER),
            (self.host / "ncu", stand_ins.NCU),
        ):
            path.write_text("#!/usr/bin/env bash\n" + body)
            path.chmod(0o755)

    def start(self, *arguments, **fakes):
        environment = {
            "PATH": f"{self.host}:/usr/bin:/bin",
            **{f"FAKE_{name.upper()}": str(value) for name, value in fakes.items()},
        }
        return subprocess.Popen(
            [self.script, "--out", self.results, "--frames", str(FRAMES), *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
        )

    def read_results(self):
        written = self.results / "results.json"
        return json.loads(written.read_text()) if written.exists() else None

    def run_script(self, *arguments, **fakes):
        """Returns exit code, output and, where there are some, results."""
        process = self.start(*arguments, **fakes)
        output, _ = process.communicate()
        return process.returncode, output, self.read_results()

    def run_steps(self, *steps, **fakes):
        return self.run_script(*[word for step in steps for word in ("--only", step)], **fakes)

    def assert_fails(self, step, chosen, **fakes):
        """Runs the chosen step and returns the one kind of step that has failed."""
        code, _, results = self.run_steps(*chosen, **fakes)
        self.assertEqual((code, results["result"]), (1, "failed"))
        failed = [s for s in results["steps"] if s["result"] == "failed"]
        self.assertEqual({s["name"].split(",")[0] for s in failed}, {step})
        return failed[0]

    def asked(self):
        """The calls of the programs, each after the environment's choice of graphs and of arrays."""
        return (self.folder / "asked").read_text().splitlines()

    def test_passes_where_everything_does_the_most_valuable_first(self):
        code, _, results = self.run_script()
        self.assertEqual((code, results["result"]), (0, "passed"))
        self.assertEqual([s["step"] for s in results["steps"]], ["gpu", *FIRST])
        self.assertTrue(
            all(s["result"] == "passed" and s["failed"] == 0 and s["skipped"] == 0 for s in results["steps"])
        )
        self.assertEqual(len({s["name"] for s in results["steps"]}), len(results["steps"]))
        self.assertNotIn("again", results["tables"])

    def test_the_first_group_fits_into_the_time_that_is_given_by_default(self):
        _, output, _ = self.run_script("--list")
        seconds = [int(line.split()[2]) for line in output.splitlines() if line.startswith("first ")]
        self.assertEqual(len(seconds), len(FIRST) - 3)
        self.assertLessEqual(sum(seconds), 8 * 60)

    def test_each_step_that_is_listed_can_be_chosen_and_hashes_are_compared_for_all_settings(self):
        _, output, _ = self.run_script("--list")
        names = [line.split()[1] for line in output.splitlines()]
        self.assertGreater(len(names), 20)
        code, _, results = self.run_steps(*names)
        self.assertEqual(code, 0, [s for s in results["steps"] if s["result"] == "failed"])
        self.assertEqual({s["step"] for s in results["steps"]}, {"gpu", *names})
        not_run = {s["step"] for s in results["steps"] if s["result"] == "not run"}
        self.assertLessEqual(not_run, {"code"})
        hashes = [s["passed"] for s in results["steps"] if s["step"] == "hashes"]
        self.assertEqual(hashes, [FRAMES] * SETTINGS)

    def test_tells_what_was_proven_on_what(self):
        _, _, results = self.run_steps("tests")
        self.assertEqual(
            (results["version"], results["commit"], results["device"]), ("0.1.0", "0123456789ab", "Some GPU")
        )
        gpu = results["gpus"][0]
        self.assertEqual(
            (gpu["name"], gpu["driver_version"], gpu["clocks_max_sm"]), ('Some "GPU"', "580.1", "1980 MHz")
        )
        self.assertTrue(results["machine"]["processor"])

    def test_keeps_each_row_with_the_step_that_it_belongs_to(self):
        _, _, results = self.run_steps("tests", "same", "kernels")
        tables = results["tables"]
        self.assertEqual([t["test"] for t in tables["tests"]], ["Cuda.Fine", "Cuda.Some"])
        self.assertEqual(tables["same"][1]["first_difference"], "vertex 7")
        self.assertEqual(tables["kernels"][0]["kernel"], "sample_list<4, false>")
        self.assertEqual(tables["kernels"][0]["case"], "1024000 splashing 1 smooth uniform")

    def test_has_a_row_for_every_goal_measured_or_not(self):
        for steps, fakes, measured in (
            (["tests"], {}, None),
            (["times"], {}, 7.5),
            (["tests"], {"refusal": "none", "no_gpu": 1}, None),
        ):
            shutil.rmtree(self.results, ignore_errors=True)
            _, _, results = self.run_steps(*steps, **fakes)
            self.assertEqual(results["goals"], [{"goal": "8 ms", "measured": measured}], steps)

    def test_goals_that_cannot_be_judged_are_a_failure(self):
        self.assert_fails("goals", ["tests"], broken_benchmark="goals")

    def test_the_second_of_two_warm_frames_of_splashsurf_counts(self):
        _, _, results = self.run_steps("splashsurf")
        self.assertEqual([row["seconds"] for row in results["tables"]["splashsurf"]], [3.25])

    def test_the_service_is_loaded_while_it_listens(self):
        _, _, results = self.run_steps("service")
        self.assertEqual(results["tables"]["service"], [{"frames": 80}])
        self.assertIn("cannot be used", self.assert_fails("service", ["service"], no_server=1)["detail"])

    # ---- Predictions

    def comparisons(self, *steps, **fakes):
        _, output, results = self.run_steps(*steps, **fakes)
        rows = results["tables"]["comparison"]
        return output, {(r["case"], r["kernel"]): r for r in rows}

    def predicted(self, case, kernel):
        """Milliseconds of the table that is shipped."""
        table = Path(GPU_CHECK).parent / "gpu-check-parts" / "predictions.csv"
        with open(table, encoding="ascii", newline="") as file:
            times = {(" ".join(row[:5]), row[5]): float(row[6]) for row in csv.reader(file) if row[0] != "particles"}
        return times[case, kernel]

    def test_a_time_stands_beside_its_prediction(self):
        _, rows = self.comparisons("times", "kernels")
        case = "1024000 splashing 1 color uniform"
        whole = rows[case, "reconstruction"]
        self.assertEqual(
            (whole["predicted_milliseconds"], whole["measured_milliseconds"]),
            (self.predicted(case, "reconstruction"), 12),
        )
        # All launches of a kernel together, whatever its template arguments.
        kernel = rows[case, "sample_list<4, false>"]
        self.assertEqual(kernel["measured_milliseconds"], 3.5)
        self.assertAlmostEqual(kernel["measured_over_predicted"], 3.5 / self.predicted(case, "sample_list"), delta=0.01)
        self.assertNotIn((case, "frame"), rows)

    def test_what_misses_its_prediction_by_more_than_twice_is_marked(self):
        case = "1024000 splashing 1 color uniform"
        expected = round(1000 * self.predicted(case, "emit_cells"))
        for microseconds, missed in (
            (expected, ""),
            (2 * expected, ""),
            (2 * expected + 1, "more than twice"),
            (expected // 2 - 1, "less than half"),
        ):
            shutil.rmtree(self.results, ignore_errors=True)
            output, rows = self.comparisons("kernels", emit=microseconds)
            self.assertEqual(rows[case, "emit_cells"]["missed"], missed)
            marked = [line for line in output.splitlines() if line.startswith("!!") and case in line]
            self.assertEqual(len(marked), 1 if missed else 0, output)

    # ---- Failures

    def test_without_a_gpu_has_its_own_exit_code(self):
        code, output, results = self.run_script(refusal='no "driver"', no_gpu=1)
        self.assertEqual((code, results["result"], results["steps"]), (77, "no GPU", []))
        self.assertEqual(output.count("\n"), 1)
        self.assertIn('no "driver"', output)

    def test_a_gpu_that_cannot_be_used_is_a_failure(self):
        self.assertIn("driver too old", self.assert_fails("gpu", ["tests"], refusal="driver too old")["detail"])

    def test_a_failure_does_not_end_the_steps_after_it(self):
        code, _, results = self.run_steps("tests", "exact", "times", failed=1)
        self.assertEqual(code, 1)
        self.assertEqual([s["result"] for s in results["steps"]], ["passed", "failed", "passed", "passed"])

    def test_a_skipped_test_is_a_failure(self):
        self.assertEqual(self.assert_fails("tests", ["tests"], skipped=2)["skipped"], 2)

    def test_no_test_at_all_is_a_failure(self):
        self.assert_fails("thousand-frames", ["thousand-frames"], passed=0)

    def test_a_test_that_failed_runs_again_without_graphs_with_guards_and_under_memcheck(self):
        asked = self.folder / "asked"
        step = self.assert_fails("tests", ["tests"], failed=3, asked=asked)
        self.assertEqual(step["failed"], 3)
        filters = "--gtest_filter=Cuda.Some"
        tests = [line for line in self.asked() if "--gtest_filter=C" in line]
        self.assertEqual(tests, [f"1  {filters}", f" guarded {filters}", f" separate {filters}"])
        again = self.read_results()["tables"]["again"]
        self.assertEqual(
            [(r["way"], r["result"]) for r in again][::2], [("MENISCUS_NO_GRAPH=1", "failed"), ("memcheck", "failed")]
        )

    def test_a_test_in_which_the_program_crashed_is_named_and_runs_again(self):
        step = self.assert_fails("tests", ["tests"], crash=1)
        self.assertIn("exit code", step["detail"])
        self.assertIn("Cuda.Some", step["detail"])
        self.assertEqual({r["case"] for r in self.read_results()["tables"]["again"]}, {"Cuda.Some"})

    def test_a_mesh_that_differs_runs_again_and_shows_that_the_graph_is_at_fault(self):
        asked = self.folder / "asked"
        step = self.assert_fails("same", ["same"], meshes="different", asked=asked)
        self.assertEqual((step["passed"], step["failed"]), (1, 2))
        results = self.read_results()
        self.assertEqual(
            [(r["way"], r["result"]) for r in results["tables"]["again"]],
            [("MENISCUS_NO_GRAPH=1", "passed"), ("MENISCUS_DEVICE_ARRAYS=guarded", "failed"), ("memcheck", "failed")],
        )
        case = "--cell-sizes 1 --fields smooth --modes uniform --waters splashing"
        small = [line for line in self.asked() if "--particles 16000 --cell-sizes" in line]
        self.assertIn(case, small[-1])
        self.assertTrue(small[-1].startswith("0 separate same"), small)

    def test_roots_that_differ_are_a_failure(self):
        self.assert_fails("exact", ["exact"], roots="different")

    def test_a_different_hash_is_named(self):
        step = self.assert_fails("hashes", ["hashes"], wrong_frame="2uniform")
        self.assertIn("--mode uniform", step["command"])
        self.assertEqual((step["detail"], step["passed"], step["failed"]), ("frame 2 differs", FRAMES - 1, 1))

    def test_frames_that_another_backend_reconstructed_prove_nothing(self):
        self.assert_fails("hashes", ["hashes"], backend="cpu")

    def test_a_hazard_is_a_failure(self):
        self.assert_fails("racecheck", ["racecheck"], hazard="racecheck")

    def test_a_broken_benchmark_is_a_failure(self):
        step = self.assert_fails("times", ["times"], broken_benchmark="scaling")
        self.assertIn('out of "memory"', step["detail"])

    # ---- What is not there

    @unittest.skipIf(INSTALLED_SANITIZER.exists(), f"{INSTALLED_SANITIZER} is installed")
    def test_a_missing_sanitizer_is_recorded(self):
        (self.host / "compute-sanitizer").unlink()
        code, _, results = self.run_steps("memcheck", "sanitizers")
        self.assertEqual(code, 0)
        self.assertEqual([s["result"] for s in results["steps"]], ["passed", *["not run"] * 5])

    @unittest.skipIf(Path("/usr/local/cuda/bin/ncu").exists(), "ncu is installed")
    def test_a_missing_profiler_is_recorded(self):
        (self.host / "ncu").unlink()
        code, _, results = self.run_steps("profile")
        self.assertEqual((code, results["steps"][1]["result"]), (0, "not run"))

    def test_a_profiler_without_rights_is_no_failure_and_says_what_to_do(self):
        code, _, results = self.run_steps("profile", no_counters=1)
        self.assertEqual((code, results["steps"][1]["result"]), (0, "not run"))
        self.assertIn("root", results["steps"][1]["detail"])

    def test_without_nvidia_smi_its_figures_are_not_known(self):
        (self.host / "nvidia-smi").unlink()
        code, _, results = self.run_steps("tests")
        self.assertEqual((code, results["gpus"]), (0, "not known"))

    # ---- Time

    def test_a_step_ends_when_its_time_is_up_and_keeps_its_rows(self):
        code, _, results = self.run_script("--only", "same", "--only", "exact", "--budget", "same=2", hang="same")
        self.assertEqual((code, results["result"]), (3, "cut off"))
        self.assertEqual([s["result"] for s in results["steps"]], ["passed", "cut off", "passed"])
        self.assertEqual([r["water"] for r in results["tables"]["same"]], ["calm"])

    def test_a_test_that_hangs_is_named(self):
        code, _, results = self.run_script("--only", "no-graph", "--budget", "no-graph=2", hanging_test=1)
        self.assertEqual(code, 3)
        self.assertIn("Cuda.Some", results["steps"][1]["detail"])
        self.assertEqual([t["test"] for t in results["tables"]["tests"]], ["Cuda.Fine"])

    def test_what_is_left_when_all_time_is_up_is_named(self):
        code, output, results = self.run_script("--only", "same", "--only", "exact", "--budget", "3", hang="same")
        self.assertEqual(code, 3)
        self.assertEqual([s["result"] for s in results["steps"]], ["passed", "cut off", "left out"])
        self.assertIn("exact", output)

    def test_two_steps_for_which_there_is_no_time_are_told_without_an_error_of_bash(self):
        code, output, _ = self.run_script("--only", "same", "--only", "exact", "--only", "times", "--budget", "1")
        self.assertEqual(code, 3)
        self.assertNotIn("gpu-check-parts", output)

    def test_a_run_that_is_killed_keeps_what_it_has(self):
        for sent, said in ((signal.SIGTERM, "interrupted"), (signal.SIGKILL, "incomplete")):
            shutil.rmtree(self.results, ignore_errors=True)
            fifo = self.folder / f"fifo-{said}"
            os.mkfifo(fifo)
            process = self.start("--only", "tests", "--only", "kernels", hang="kernels", fifo=fifo)
            with open(fifo) as hanging:
                hanging.readline()
            # The row was read before the next line can be; the script then waits for one.
            self.wait_for_rows(process, "kernels", 1)
            process.send_signal(sent)
            process.wait()
            process.stdout.close()
            results = self.read_results()
            self.assertEqual(results["result"], said)
            self.assertEqual([s["step"] for s in results["steps"]], ["gpu", "tests"])
            self.assertEqual([r["median_us"] for r in results["tables"]["kernels"]], [3000])

    def wait_for_rows(self, process, table, count):
        while len(self.read_results()["tables"].get(table, [])) < count:
            self.assertIsNone(process.poll())

    # ---- Arguments

    def test_results_that_cannot_be_written_end_it(self):
        (self.results / "results.json.part").mkdir(parents=True)
        code, output, _ = self.run_steps("exact")
        self.assertEqual(code, 2)
        self.assertNotIn("passed", output)

    def test_any_name_makes_valid_results(self):
        _, _, results = self.run_steps("tests", device='"\\\t\x01 é')
        self.assertEqual(results["device"], '"\\?? ??')

    def test_refuses_wrong_arguments(self):
        for arguments in (
            ["--only", "levitate"],
            ["levitate"],
            ["--frames", "0"],
            ["--particles", "63"],
            ["--budget", "0"],
            ["--budget", "same="],
            ["--budget", "levitate=3"],
            ["--out"],
        ):
            code, output, _ = self.run_script(*arguments)
            self.assertEqual((code, output.count("\n")), (2, 1), arguments)


if __name__ == "__main__":
    unittest.main()
