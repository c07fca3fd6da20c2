"""The packages that CPack makes of a build. Needs no root; installs nothing.

Usage: packages_test.py BUILD CMAKE VERSION WITH-PYTHON (ON or OFF)"""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

*_, BUILD, CMAKE, VERSION, WITH_PYTHON = sys.argv
del sys.argv[1:]
CPACK = Path(CMAKE).with_name("cpack")
NAMES = {"meniscusd", "meniscus", "libmeniscus0", "libmeniscus-dev"} | (
    {"python3-meniscus"} if WITH_PYTHON == "ON" else set()
)
REPOSITORY = Path(__file__).parents[3]


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=200).stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        output_of(str(CPACK), "--config", f"{BUILD}/CPackConfig.cmake", "-G", "DEB", "-B", folder.name)
        cls.files = {path.name.partition("_")[0]: path for path in Path(folder.name).glob("*.deb")}
        cls.folder = folder.name

    def fields(self, package):
        text = output_of("dpkg-deb", "--field", str(self.files[package]))
        return dict(re.findall(r"^(\S+): (.*(?:\n .*)*)", text, re.MULTILINE))

    def contents(self, package):
        """Path to mode and owner."""
        lines = output_of("dpkg-deb", "--contents", str(self.files[package])).splitlines()
        parts = (line.split(maxsplit=5) for line in lines)
        return {path.removeprefix("."): (mode, owner) for mode, owner, _, _, _, path in parts}

    def programs(self, package):
        return {
            path
            for path, (mode, _) in self.contents(package).items()
            if path.startswith("/usr/bin/") and mode[0] == "-"
        }

    def test_are_those_that_the_build_has(self):
        self.assertEqual(set(self.files), NAMES)

    def test_have_the_projects_version_and_so_has_the_changelog(self):
        changelog = (REPOSITORY / "deploy" / "package" / "changelog").read_text()
        self.assertTrue(changelog.startswith(f"meniscus ({VERSION}-1) "), changelog.splitlines()[0])
        for package in NAMES:
            self.assertEqual(self.fields(package)["Version"], f"{VERSION}-1")

    def test_say_what_they_are(self):
        for package in NAMES:
            fields = self.fields(package)
            summary, *text = fields["Description"].splitlines()
            self.assertLess(len(summary), 81)
            self.assertGreater(len(text), 1, package)
            self.assertLess(max(map(len, text)), 81, package)
            self.assertRegex(fields["Maintainer"], r"^\S.* <\S+@\S+>$")
            self.assertEqual(fields["Architecture"], output_of("dpkg", "--print-architecture").strip())

    def test_need_the_libraries_behind_their_programs(self):
        for package in NAMES - {"libmeniscus-dev"}:
            for library in ("libc6", "libgrpc++", "libdraco", "libtbb"):
                self.assertRegex(self.fields(package)["Depends"], rf"(^|, ){re.escape(library)}", package)

    def test_have_the_programs_each_with_its_page(self):
        self.assertEqual(self.programs("meniscusd"), {"/usr/bin/meniscusd"})
        self.assertEqual(self.programs("meniscus"), {"/usr/bin/meniscus", "/usr/bin/meniscus-load"})
        for package in NAMES - {"meniscusd", "meniscus"}:
            self.assertEqual(self.programs(package), set())
        for package in NAMES:
            paths = self.contents(package).keys()
            for program in self.programs(package):
                self.assertTrue(
                    any(
                        re.fullmatch(rf"/usr/share/man/man[18]/{Path(program).name}\.[18]\.gz", path) for path in paths
                    ),
                    program,
                )

    def test_complete_the_command_line_in_the_shells_of_debian(self):
        for path in ("bash-completion/completions/meniscus", "zsh/vendor-completions/_meniscus"):
            self.assertIn(f"/usr/share/{path}", self.contents("meniscus"))

    def test_have_their_license_and_their_changes(self):
        for package in NAMES:
            for document in ("copyright", "changelog.Debian.gz"):
                self.assertIn(f"/usr/share/doc/{package}/{document}", self.contents(package))

    def test_belong_to_root_who_alone_may_write(self):
        for package in NAMES:
            for path, (mode, owner) in self.contents(package).items():
                wanted = "rwxr-xr-x" if mode[0] == "d" or path.startswith("/usr/bin/") else "rw-r--r--"
                if mode[0] == "l":
                    wanted = "rwxrwxrwx"
                self.assertEqual((owner, mode[1:]), ("root/root", wanted), path)

    def test_have_their_files_where_debian_has_them(self):
        for package in NAMES:
            for path in self.contents(package):
                self.assertRegex(
                    path, r"^/((usr|usr/(bin|include|lib|share)(/.*)?|etc|etc/meniscus/.*|lib|lib/systemd/.*)?/?)$"
                )

    def test_keep_what_the_operator_has_changed(self):
        output_of("dpkg-deb", "--control", str(self.files["meniscusd"]), f"{self.folder}/control")
        conffiles = Path(self.folder, "control", "conffiles").read_text().split()
        self.assertEqual(conffiles, [path for path in self.contents("meniscusd") if re.match(r"/etc/.*[^/]$", path)])

    def test_have_what_is_found_by_cmake(self):
        paths = self.contents("libmeniscus-dev").keys()
        for ending in (
            "/cmake/Meniscus/MeniscusConfig.cmake",
            "/libmeniscus_client.a",
            "/libmeniscus_core.a",
            "/include/meniscus/client/client.hpp",
            "/include/meniscus/meniscus.h",
            "/include/meniscus/mpi.h",
            "/pkgconfig/meniscus.pc",
            "/share/doc/libmeniscus-dev/examples/in_process.c",
        ):
            self.assertTrue(any(path.endswith(ending) for path in paths), ending)

    def test_have_the_shared_library_apart_from_what_builds_with_it(self):
        libraries = {
            package: {
                re.sub(r"^.*/|( -> .*)", "", path)
                for path in self.contents(package)
                if re.search(r"/libmeniscus\.so", path)
            }
            for package in NAMES
        }
        self.assertEqual(libraries["libmeniscus0"], {"libmeniscus.so.0", f"libmeniscus.so.{VERSION}"})
        self.assertEqual(libraries["libmeniscus-dev"], {"libmeniscus.so"})
        self.assertIn(f"libmeniscus0 (= {VERSION}-1)", self.fields("libmeniscus-dev")["Depends"])
        output_of("dpkg-deb", "--control", str(self.files["libmeniscus0"]), f"{self.folder}/library")
        shlibs = Path(self.folder, "library", "shlibs").read_text()
        self.assertRegex(shlibs, rf"(?m)^libmeniscus 0 libmeniscus0 \(>= {re.escape(VERSION)}")
        self.assertIn("ldconfig", Path(self.folder, "library", "triggers").read_text())

    @unittest.skipUnless(WITH_PYTHON == "ON", "built without Python")
    def test_have_the_python_package_where_its_python_looks(self):
        folder = "/usr/lib/python3/dist-packages/meniscus/"
        paths = self.contents("python3-meniscus").keys()
        packed = {path.removeprefix(folder) for path in paths if path.startswith(folder)} - {""}
        extensions = {name for name in packed if name.endswith(".so")}
        self.assertEqual(len(extensions), 1, packed)
        modules = REPOSITORY / "client" / "python" / "meniscus"
        self.assertEqual(packed - extensions, {path.name for path in modules.iterdir() if path.is_file()})
        python = re.fullmatch(r"_meniscus\.cpython-3(\d+)-.*\.so", extensions.pop())
        depends = self.fields("python3-meniscus")["Depends"].split(", ")
        minor = int(python.group(1))
        for needed in (f"python3 (>= 3.{minor})", f"python3 (<< 3.{minor + 1})", "python3-numpy"):
            self.assertIn(needed, depends)
        output_of("dpkg-deb", "--control", str(self.files["python3-meniscus"]), f"{self.folder}/python")
        for script, program in (("postinst", "py3compile"), ("prerm", "py3clean")):
            self.assertIn(f"{program} -p python3-meniscus", Path(self.folder, "python", script).read_text())
        for what in ("blender/meniscus_blender.zip", "paraview/load_meniscus.py", "paraview/meniscus_paraview.py"):
            self.assertIn("/usr/share/meniscus/" + what, paths)
        examples = {path.name for path in (REPOSITORY / "client" / "python" / "examples").iterdir() if path.is_file()}
        folder = "/usr/share/doc/python3-meniscus/examples/"
        self.assertEqual({path.removeprefix(folder) for path in paths if path.startswith(folder)} - {""}, examples)


class Install(unittest.TestCase):
    def test_without_a_component_stays_below_its_prefix(self):
        with tempfile.TemporaryDirectory() as root:
            subprocess.run(
                [CMAKE, "--install", BUILD, "--prefix", "/opt/meniscus"],
                check=True,
                capture_output=True,
                timeout=60,
                env={"DESTDIR": root, "PATH": "/usr/bin:/bin"},
            )
            self.assertEqual([path.name for path in Path(root).iterdir()], ["opt"])
            self.assertEqual(
                {path.name for path in Path(root, "opt/meniscus/bin").iterdir()},
                {"meniscusd", "meniscus", "meniscus-load"},
            )


if __name__ == "__main__":
    unittest.main()
