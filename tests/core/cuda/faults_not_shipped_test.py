"""What puts faults in force is in the software device's copies of core's sources alone: neither core's sources nor the
library that is shipped know of it.

    faults_not_shipped_test.py NM CORE SHIPPED_LIBRARY SOFTWARE_DEVICE
"""

import pathlib
import re
import subprocess
import sys
import unittest

NM, CORE, SHIPPED, SOFTWARE_DEVICE = sys.argv[1:]
MARK = re.compile(r"emulated_device|FAULTY\(|Fault::")


def marked_symbols(library):
    symbols = subprocess.run([NM, "--demangle", library], capture_output=True, text=True, check=True).stdout
    return [line for line in symbols.splitlines() if MARK.search(line)]


class Faults(unittest.TestCase):
    def test_are_in_the_software_device(self):
        self.assertTrue(any("emulated_device::fault" in symbol for symbol in marked_symbols(SOFTWARE_DEVICE)))

    def test_are_in_no_symbol_of_the_shipped_library(self):
        self.assertEqual(marked_symbols(SHIPPED), [])

    def test_are_in_no_source_of_core(self):
        sources = [path for path in pathlib.Path(CORE).rglob("*") if path.suffix in (".cu", ".hpp", ".cpp")]
        self.assertGreater(len(sources), 100)
        self.assertEqual([path for path in sources if MARK.search(path.read_text())], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
