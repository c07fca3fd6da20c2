"""What is compiled for a wider instruction set than the processor may have cannot run by accident: an object with the
CPU's loops shares no symbols with the program but its two entries, and nothing in it runs before it is called.

    instruction_sets_test.py NM READELF OBJECT...
"""

import subprocess
import sys
import unittest

NM, READELF, *OBJECTS = sys.argv[1:]


def lines(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


class LoopsOfAnInstructionSet(unittest.TestCase):
    def test_define_two_symbols_for_others(self):
        for path in OBJECTS:
            with self.subTest(path):
                symbols = [line.split(maxsplit=2) for line in lines(NM, "--defined-only", path)]
                self.assertGreater(len(symbols), 100, "the loops are in it")
                # nm: letters of local symbols are small; u, v and w are not local.
                shared = [name for _, kind, name in symbols if kind.isupper() or kind in "uvw"]
                self.assertEqual(len(shared), 2, shared)
                self.assertIn("make_lattice_coder", shared[0])
                self.assertIn("make_reconstruction", shared[1])

    def test_run_nothing_before_they_are_called(self):
        for path in OBJECTS:
            with self.subTest(path):
                sections = "\n".join(lines(READELF, "--sections", "--wide", path))
                self.assertIn(".text", sections)
                for section in (".init_array", ".ctors", ".preinit_array", "IFUNC"):
                    self.assertNotIn(section, sections)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
