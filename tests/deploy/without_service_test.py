"""A build without the service stays one that needs nothing: without_service_test.py CMAKE SOURCE CXX_COMPILER NINJA.

It is configured here as on a machine with a compiler alone, and what stands in for the libraries is compiled; the whole
is built by tests/acceptance/core-in-debian."""

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

CMAKE, SOURCE, COMPILER, NINJA = sys.argv[1:5]
#: Packages of find_package(), and what a build lacks without each.
PACKAGES = {
    "TBB": "std::thread",
    "draco": "codec draco",
    "OpenSSL": "mesh_sha256",
    "nlohmann_json": r"\.glb",
    "PNG": "pictures",
    "pugixml": r"\.vtp",
    "ZLIB": r"\.npz",
}
OTHERS = ["HDF5", "Python", "pybind11", "GTest", "CUDAToolkit", "gRPC", "Protobuf", "Boost", "CLI11"]


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, f"{command}:\n{done.stdout[-4000:]}{done.stderr[-4000:]}"
    return done.stdout + done.stderr


class WithoutTheService(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="meniscus-")
        cls.addClassCleanup(cls.folder.cleanup)
        options = ["MENISCUS_SERVICE=OFF", "MENISCUS_CUDA=OFF", "MENISCUS_UNITY=OFF", "CMAKE_CXX_FLAGS=-Werror"]
        options += [f"CMAKE_DISABLE_FIND_PACKAGE_{package}=ON" for package in [*PACKAGES, *OTHERS]]
        options += ["XXHASH_INCLUDE_DIR=", f"CMAKE_CXX_COMPILER={COMPILER}", f"CMAKE_MAKE_PROGRAM={NINJA}"]
        flags = [f"-D{option}" for option in options]
        cls.said = run(CMAKE, "-S", SOURCE, "-B", cls.folder.name, "-G", "Ninja", *flags)
        cls.targets = set(re.findall(r"^(\S+): phony", run(NINJA, "-C", cls.folder.name, "-t", "targets", "all"), re.M))

    def test_each_missing_part_is_named_with_what_it_takes_away(self):
        for package, loss in PACKAGES.items():
            self.assertRegex(self.said, f"-- Without {package}: .*{loss}")
        self.assertRegex(self.said, "-- Without xxHash: ")
        self.assertRegex(self.said, "-- Without GTest: no tests")

    def test_core_and_the_c_interface_are_built_and_nothing_of_the_service(self):
        self.assertLessEqual({"meniscus_core", "meniscus_c", "meniscus_formats"}, self.targets)
        of_service = {"meniscus_client", "meniscus_proto", "meniscusd", "meniscus", "meniscus_files"}
        self.assertFalse(of_service & self.targets)

    def test_what_stands_in_for_missing_parts_compiles(self):
        with open(f"{self.folder.name}/compile_commands.json") as file:
            commands = {c["file"]: c["command"] for c in json.load(file)}
        # They consist of the service's messages.
        self.assertFalse([file for file in commands if "/recordings/" in file])
        standing_in = {
            file: commands[file]
            for file in commands
            if re.search("/absent/|/client/pushing/|/client/ranks/piped_", file)
        }
        names = {os.path.splitext(os.path.basename(file))[0] for file in standing_in}
        # Of .glb nothing is there without nlohmann-json, whatever Draco would make of it.
        libraries = {"bricks", "draco", "glb", "hdf5", "json", "openssl", "png", "pugixml", "zlib"}
        of_c = {"publishing", "pushing", "through_push", "watching"}
        pushing = {"brick_bytes", "frame_bytes", "json_line", "push_answer", "push_options", "push_process"}
        pushing |= {"piped_upload", "pushed_upload", "statistics_message"}
        self.assertEqual(names, libraries | of_c | pushing)
        for command in standing_in.values():
            run(*shlex.split(command), "-fsyntax-only")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
