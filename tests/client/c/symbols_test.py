"""The symbols of libmeniscus.so: symbols_test.py LIBRARY HEADER MAP NM READELF.

Its functions are those of the header, each in the version script, and nothing else: another library of the same process
may have gRPC, Protocol Buffers, Draco or CUDA of its own."""

import re
import subprocess
import sys
import unittest
from pathlib import Path

*_, LIBRARY, HEADER, MAP, NM, READELF = sys.argv
del sys.argv[1:]


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout


def functions_of_header():
    text = re.sub(r"/\*.*?\*/", "", Path(HEADER).read_text(), flags=re.DOTALL)
    return re.findall(r"^MENISCUS_API\s[^;(]*?(\w+)\(", text, re.MULTILINE)


class Symbols(unittest.TestCase):
    def test_are_the_functions_of_the_header_and_nothing_else(self):
        exported = [line.split() for line in output_of(NM, "-D", "--defined-only", LIBRARY).splitlines()]
        names = {name.split("@")[0] for _, kind, name in exported if kind != "A"}  # A: the versions themselves
        functions = functions_of_header()
        self.assertGreater(len(functions), 30)
        self.assertEqual(len(functions), len(set(functions)))
        self.assertEqual(names, set(functions))

    def test_have_the_version_that_the_script_gives_them(self):
        versions = dict(re.findall(r"(\w+)@@(\S+)", output_of(NM, "-D", "--defined-only", LIBRARY)))
        script = re.sub(r"/\*.*?\*/", "", Path(MAP).read_text(), flags=re.DOTALL)
        expected = {}
        for version, content in re.findall(r"^(\S+) \{(.*?)\}", script, re.MULTILINE | re.DOTALL):
            for name in re.findall(r"\b(meniscus_\w+);", content):
                self.assertNotIn(name, expected)
                expected[name] = version
        self.assertEqual(versions, expected)

    def test_are_found_under_the_name_that_programs_remember(self):
        dynamic = output_of(READELF, "--dynamic", "--wide", LIBRARY)
        self.assertRegex(dynamic, r"\(SONAME\).*\[libmeniscus\.so\.0\]")
        self.assertRegex(dynamic, r"\(FLAGS_1\).*\bNODELETE\b")
        # Whatever of CUDA there is lies inside.
        self.assertNotRegex(dynamic, r"\(NEEDED\).*cuda")


if __name__ == "__main__":
    unittest.main()
