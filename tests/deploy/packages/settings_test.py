"""The table of settings, against all that follows from it: settings_test.py DOCUMENT MAN_PAGE PROTO MENISCUS.

The table in DOCUMENT is where settings are described: flag, default, meaning. The program, its man page and the
contract must have the same settings with the same defaults.
"""

import re
import sys
import unittest
from pathlib import Path

from flags import flags_of, help_of, items_of, subsections_of

*_, DOCUMENT, MAN_PAGE, PROTO, MENISCUS = sys.argv
del sys.argv[1:]

# Fields of the contract whose names are not those of their flags.
FIELDS = {
    "tolerance": "CurvatureCriterion.tolerance",
    "count-threshold": "CountCriterion.threshold",
    "bisection-steps": "Bisection.steps",
}
# What a frame, not a session, is uploaded with.
NOT_IN_THE_CONTRACT = {"positions"}


def table():
    """Flag to default, as it is written: a value, `required`, `none` or nothing."""
    section = re.search(r"^##+ Settings$(.*?)(?=^##|\Z)", Path(DOCUMENT).read_text(), re.MULTILINE | re.DOTALL).group(1)
    return {
        flag: default.strip().strip("`")
        for flag, default in re.findall(r"^\| `--([a-z-]+)` \|([^|]*)\|", section, re.MULTILINE)
    }


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
        declarations = r"((?:^ *//.*\n)+) *(?:oneof (\w+) \{|(?:optional )?[\w.]+ (\w+) = \d+;)"
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
        settings = set(items_of(sections["The reconstruction"])) - {"normals"}  # a pair with no-normals
        self.assertEqual(settings, set(self.table) - {"particle-radius"} - NOT_IN_THE_CONTRACT)
        items = {flag: text for section in sections.values() for flag, text in items_of(section).items()}
        for flag in self.table:
            default = re.search(r"Default: (\S+)\.(?:\s|$)", items[flag])
            self.assert_same_default(flag, default and default.group(1))

    def test_the_contract_has_each_setting_with_its_default(self):
        fields = contract()
        for flag in set(self.table) - NOT_IN_THE_CONTRACT - {"no-normals"}:
            field = FIELDS.get(flag, "Settings." + flag.replace("-", "_"))
            self.assertIn(field, fields)
            self.assert_same_default(flag, fields[field])
        self.assertEqual(fields["Settings.normals"], "true")


if __name__ == "__main__":
    unittest.main()
