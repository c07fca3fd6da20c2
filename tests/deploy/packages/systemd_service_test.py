"""The service that the package installs: systemd_service_test.py PACKAGE-SOURCES MENISCUSD SETTINGS-FILE."""

import configparser
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

*_, SOURCES, MENISCUSD, SETTINGS = sys.argv
del sys.argv[1:]
SERVICE = Path(SOURCES) / "service"
INSTALLED_SETTINGS = "/etc/meniscus/meniscus.conf"
# systemd-analyze's exposure is this over ten; below 2 it says "OK".
MOST_EXPOSURE = 15


def run(*command):
    return subprocess.run(
        command, capture_output=True, text=True, timeout=60, env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin"}
    )


def settings_in(text):
    """Name to value of what a file of settings sets."""
    lines = (line.partition("=") for line in text.splitlines() if line and not line.startswith("#"))
    return {name.strip(): value.strip() for name, _, value in lines}


class Unit(unittest.TestCase):
    def setUp(self):
        self.unit = configparser.ConfigParser(strict=False, interpolation=None, delimiters="=")
        self.unit.optionxform = str
        self.unit.read(SERVICE / "meniscusd.service")

    def test_gives_the_server_longer_to_stop_than_the_server_gives_its_clients(self):
        grace = float(settings_in(run(MENISCUSD, "--print-config").stdout)["shutdown-grace"])
        self.assertGreater(float(self.unit["Service"]["TimeoutStopSec"]), grace)

    def test_runs_as_the_user_that_is_made_for_it(self):
        made = (SERVICE / "meniscusd.sysusers").read_text().split()
        self.assertEqual(made[:2], ["u", self.unit["Service"]["User"]])

    def test_reads_the_settings_that_are_installed(self):
        self.assertEqual(self.unit["Service"]["ExecStart"], f"/usr/bin/meniscusd --config {INSTALLED_SETTINGS}")
        self.assertIn(INSTALLED_SETTINGS, (SERVICE.parent / "control" / "conffiles").read_text().splitlines())


@unittest.skipUnless(shutil.which("systemd-analyze"), "systemd-analyze is not installed")
class UnitOfSystemd(unittest.TestCase):
    """Verified where the program is installed, with and without the GPU's drop-in."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        unit = (SERVICE / "meniscusd.service").read_text()
        (self.folder / "meniscusd.service").write_text(unit.replace("/usr/bin/meniscusd", MENISCUSD))

    def add_drop_in(self):
        drop_in = self.folder / "meniscusd.service.d" / "gpu.conf"
        drop_in.parent.mkdir()
        shutil.copy(SERVICE / "gpu.conf", drop_in)

    def assert_verifies(self):
        verified = run("systemd-analyze", "verify", "--man=no", str(self.folder / "meniscusd.service"))
        self.assertEqual((verified.returncode, verified.stderr), (0, ""))

    def test_verifies(self):
        self.assert_verifies()

    def test_verifies_with_the_drop_in_for_gpus(self):
        self.add_drop_in()
        self.assert_verifies()

    def test_exposes_little(self):
        judged = run(
            "systemd-analyze",
            "security",
            "--offline=yes",
            f"--threshold={MOST_EXPOSURE}",
            "--no-pager",
            str(self.folder / "meniscusd.service"),
        )
        self.assertEqual(judged.returncode, 0, judged.stdout[-400:] + judged.stderr)


class Settings(unittest.TestCase):
    def setUp(self):
        self.text = Path(SETTINGS).read_text()
        self.defaults = run(MENISCUSD, "--print-config").stdout

    def print_config(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".conf") as file:
            file.write(text)
            file.flush()
            checked = run(MENISCUSD, "--config", file.name, "--check-config", "--listen", "127.0.0.1:0")
            self.assertEqual((checked.returncode, checked.stderr), (0, ""))
            return run(MENISCUSD, "--config", file.name, "--print-config").stdout

    def test_as_installed_are_the_defaults(self):
        self.assertEqual(settings_in(self.text), {})
        self.assertEqual(self.print_config(self.text), self.defaults)

    def test_name_every_setting_with_its_default(self):
        uncommented = re.sub(r"^# ([a-z-]+ = )", r"\1", self.text, flags=re.MULTILINE)
        self.assertEqual(self.print_config(uncommented), self.defaults)
        named = re.findall(r"^# ([a-z-]+) =", self.text, re.MULTILINE)
        self.assertEqual(named, re.findall(r"^(?:# )?([a-z-]+) =", self.defaults, re.MULTILINE))
        self.assertGreater(len(settings_in(uncommented)), 10)

    def test_have_no_figures_of_the_machine_that_made_them(self):
        same_everywhere = ("100000000", "536870912")  # --max-particles, --publish-limit
        memory = [
            value
            for value in settings_in(self.defaults).values()
            if re.fullmatch(r"\d{9,}", value) and value not in same_everywhere
        ]
        for value in memory:
            self.assertNotIn(value, self.text)


if __name__ == "__main__":
    unittest.main()
