"""What deploy/release asks for before it builds anything: release_test.py SOURCE-FOLDER.

Each test looks at a repository that has the files in which a version is written, and the script."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop())
PACKAGES = ("client/web", "tests/web", "tests/deploy/kubernetes")
FILES = [
    "CMakeLists.txt",
    "deploy/release",
    "deploy/package/changelog",
    "deploy/container/Dockerfile",
    ".github/CHANGELOG.md",
]
FILES += [f"{folder}/{file}" for folder in PACKAGES for file in ("package.json", "package-lock.json")]


class Release(unittest.TestCase):
    def setUp(self):
        root = tempfile.TemporaryDirectory()
        self.addCleanup(root.cleanup)
        self.root = Path(root.name)
        for name in FILES:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.root / name)
        text = (self.root / "CMakeLists.txt").read_text()
        self.version = text.split("project(Meniscus VERSION ")[1].split()[0]
        changelog = self.root / ".github/CHANGELOG.md"
        changelog.write_text(f"# Changelog\n\n## {self.version}\n\n* Something.\n")
        # The last thing that is looked at, so that nothing is ever built here.
        (self.root / "out").mkdir()

    def refusal(self, *arguments):
        run = subprocess.run(
            [self.root / "deploy/release", *arguments], capture_output=True, text=True, timeout=60, cwd=self.root
        )
        self.assertEqual(run.returncode, 1, run)
        return run.stderr

    def replace(self, name, old, new):
        file = self.root / name
        text = file.read_text()
        self.assertIn(old, text)
        file.write_text(text.replace(old, new))

    def test_wants_a_version_and_a_folder_that_is_not_there(self):
        for wrong in ("", "v1.0.0", "1.0", "1.0.0-rc1"):
            self.assertIn(f"the version is '{wrong}', must be three numbers", self.refusal(wrong))
        self.assertIn("out is there already", self.refusal(self.version, str(self.root / "out")))

    def test_wants_the_version_wherever_it_is_written(self):
        self.assertIn(f"CMakeLists.txt has version {self.version}, must be 99.0.0", self.refusal("99.0.0"))
        written = {
            "deploy/package/changelog": f"meniscus ({self.version}-1)",
            ".github/CHANGELOG.md": f"## {self.version}",
            "deploy/container/Dockerfile": f"ARG VERSION={self.version}",
        }
        for folder in PACKAGES:
            for file in ("package.json", "package-lock.json"):
                written[f"{folder}/{file}"] = f'"version": "{self.version}"'
        for name, text in written.items():
            kept = (self.root / name).read_text()
            self.replace(name, text, text.replace(self.version, "99.0.0"))
            self.assertIn(name, self.refusal(self.version, str(self.root / "out")))
            (self.root / name).write_text(kept)


if __name__ == "__main__":
    unittest.main()
