"""The table of settings, against all that follows from it: settings_test.py DOCUMENT MAN_PAGE PROTO MENISCUS.

The table in DOCUMENT is where settings are described: flag, default, meaning. The program, its man page and the
contract must have the same settings with the same defaults. The table of presets there says which flags each one stands
for; the program must make the same mesh of both.
"""

import json
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from flags import flags_of, help_of, items_of, subsections_of

*_, DOCUMENT, MAN_PAGE, PROTO, MENISCUS = sys.argv
del sys.argv[1:]

# Fields of the contract whose names are not those of their flags.
FIELDS = {
    "attribute": "Settings.attributes",
    "tolerance": "CurvatureCriterion.tolerance",
    "count-threshold": "CountCriterion.threshold",
    "bisection-steps": "Bisection.steps",
}
# Fields whose default was another once: absent, they keep their first meaning. Clients spell them out.
ABSENT = {"CurvatureCriterion.tolerance": "0.15"}
# Options of a frame's upload, not of a session.
NOT_OF_THE_SESSION = {"positions"}
# Nor is a preset: clients spell its settings out.
NOT_IN_THE_CONTRACT = NOT_OF_THE_SESSION | {"preset"}


def table():
    """Flag to default, as it is written: a value, `required`, `none` or nothing."""
    section = re.search(r"^##+ Settings$(.*?)(?=^##|\Z)", Path(DOCUMENT).read_text(), re.MULTILINE | re.DOTALL).group(1)
    return {
        flag: default.strip().strip("`")
        for flag, default in re.findall(r"^\| `--([a-z-]+)` \|([^|]*)\|", section, re.MULTILINE)
    }


def presets():
    """Preset to the flags that it stands for."""
    section = re.search(r"^##+ Presets$(.*?)(?=^##|\Z)", Path(DOCUMENT).read_text(), re.MULTILINE | re.DOTALL).group(1)
    return {name: flags.split() for name, flags in re.findall(r"^\| `(\w+)` \|[^|]*\| `(--[^`]+)` \|$", section, re.M)}


def mesh_of(*flags):
    """Hash of the mesh of nine particles, some of them close together."""
    with tempfile.TemporaryDirectory() as folder:
        particles, figures = Path(folder, "particles.xyz"), Path(folder, "figures.json")
        at = [(0.4 * i, 0.3 * j, 0.05 * i * j) for i in range(3) for j in range(3)]
        particles.write_bytes(b"".join(struct.pack("<3f", *p) for p in at))
        command = [MENISCUS, "reconstruct", particles, "--particle-radius", "0.25", "--stats", figures, *flags]
        subprocess.run(command, check=True, capture_output=True, timeout=60)
        return json.loads(figures.read_text())["mesh_sha256"]


def has_default(written):
    return written not in ("required", "none", "")


def same(written, default):
    """Whether two texts are the same default: 2.0 is 2."""
    try:
        return float(written) == float(default)
    except (TypeError, ValueError):
        return written == default


def contract():
    """Message.field to default (None: none is given). A choice of messages is a field, too."""
    fields = {}
    text = Path(PROTO).read_text()
    for message, body in re.findall(r"^message (\w+) \{\n(.*?)^\}", text, re.MULTILINE | re.DOTALL):
        declarations = r"((?:^ *//.*\n)+) *(?:oneof (\w+) \{|(?:optional |repeated )?[\w.]+ (\w+) = \d+;)"
        for comment, choice, field in re.findall(declarations, body, re.MULTILINE):
            default = re.search(r"Default (\S+)\.$", comment, re.MULTILINE)
            # FIELD_COLOR is color.
            fields[f"{message}.{choice or field}"] = default and default.group(1).rpartition("_")[2].lower()
    return fields


class Settings(unittest.TestCase):
    def setUp(self):
        self.table = table()
        self.assertGreater(len(self.table), 10)

    def assert_same_default(self, flag, default):
        written = self.table[flag]
        if has_default(written):
            self.assertTrue(same(written, default), f"--{flag}: {written} in {DOCUMENT}, here {default}")
        else:
            self.assertIsNone(default, flag)

    def test_the_program_has_each_setting_with_its_default(self):
        flags = flags_of(help_of(MENISCUS, "reconstruct"))
        for flag in self.table:
            self.assertIn(flag, flags)
            self.assert_same_default(flag, flags[flag])

    def test_the_man_page_has_exactly_these_settings_with_their_defaults(self):
        sections = subsections_of(Path(MAN_PAGE).read_text())
        settings = set(items_of(sections["The reconstruction"])) - {"normals", "no-normals"}  # one row for both
        self.assertEqual(settings, set(self.table) - {"particle-radius"} - NOT_OF_THE_SESSION)
        items = {flag: text for section in sections.values() for flag, text in items_of(section).items()}
        for flag in self.table:
            default = re.search(r"Default: (\S+)\.(?:\s|$)", items[flag])
            self.assert_same_default(flag, default and default.group(1))

    def test_the_contract_has_each_setting_with_its_default(self):
        fields = contract()
        for flag in set(self.table) - NOT_IN_THE_CONTRACT:
            field = FIELDS.get(flag, "Settings." + flag.replace("-", "_"))
            self.assertIn(field, fields)
            if field not in ABSENT:
                self.assert_same_default(flag, fields[field])
        self.assertEqual(fields["Settings.normals"], "true")
        self.assertEqual({field: fields[field] for field in ABSENT}, ABSENT)

    def test_each_preset_is_the_flags_that_the_document_says(self):
        offered = re.search(r"--preset .*?\{([\w,]+)\}", help_of(MENISCUS, "reconstruct"), re.DOTALL).group(1)
        self.assertEqual(set(offered.split(",")), set(presets()))
        for preset, flags in presets().items():
            self.assertEqual(mesh_of("--preset", preset), mesh_of(*flags), preset)
        self.assertEqual(mesh_of("--preset", self.table["preset"]), mesh_of())


if __name__ == "__main__":
    unittest.main()
