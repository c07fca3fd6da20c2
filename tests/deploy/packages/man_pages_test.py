"""The flags in the man pages against those in the programs' help.

Usage: man_pages_test.py PAGES MENISCUSD MENISCUS MENISCUS-LOAD"""

import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from flags import flags_of, help_of, items_of, subsections_of

*_, PAGES, MENISCUSD, MENISCUS, MENISCUS_LOAD = sys.argv
del sys.argv[1:]
PAGES = Path(PAGES)


class ManPages(unittest.TestCase):
    def assert_says_what_help_says(self, items, help_text, name):
        flags = flags_of(help_text)
        self.assertGreater(len(flags), 0, name)
        self.assertEqual(sorted(items), sorted(flags), name)
        for flag, default in flags.items():
            if default is not None:
                self.assertIn(f"Default: {default}.", items[flag].replace("\n", " "), f"{name} --{flag}")

    def test_the_server_has_exactly_the_flags_of_its_page_with_their_defaults(self):
        items = items_of((PAGES / "meniscusd.8").read_text())
        self.assert_says_what_help_says(items, help_of(MENISCUSD), "meniscusd.8")

    def test_the_load_generator_has_exactly_the_flags_of_its_page_and_of_the_sections_it_refers_to(self):
        page = (PAGES / "meniscus-load.1").read_text()
        sections = subsections_of((PAGES / "meniscus.1").read_text())
        references = re.findall(
            r"^\.Xr meniscus 1\nunder\n\.Dq (.*?) [.,]\n(?:except for\n\.Fl -([a-z-]+) \.\n)?", page, re.MULTILINE
        )
        self.assertEqual(len(references), 2)
        items = items_of(page)
        for section, exception in references:
            shared = items_of(sections[section])
            items |= {flag: shared[flag] for flag in shared.keys() - items.keys() - {exception}}
        self.assert_says_what_help_says(items, help_of(MENISCUS_LOAD), "meniscus-load.1")

    def test_each_command_has_exactly_the_flags_of_its_section_and_of_those_it_refers_to(self):
        sections = subsections_of((PAGES / "meniscus.1").read_text())
        overview = help_of(MENISCUS)
        commands = re.findall(r"^  ([a-z]+) {2,}\S", overview.partition("Subcommands:")[2], re.MULTILINE)
        self.assertGreater(len(commands), 1)
        general = items_of(sections["DESCRIPTION"])
        self.assert_says_what_help_says(general, overview, "meniscus")
        titles = {title.split()[0]: title for title in sections if title[0].islower()}
        self.assertEqual(sorted(titles), sorted(commands))
        for command in commands:
            text = sections[titles[command]]
            items = {"help": general["help"]} | items_of(text)
            for reference in re.findall(r"^\.Sx (.*?)(?: [.,])?$", text, re.MULTILINE):
                shared = items_of(sections[reference])
                items |= {flag: shared[flag] for flag in shared.keys() - items.keys()}
            self.assert_says_what_help_says(items, help_of(MENISCUS, command), command)

    def test_each_page_has_the_variables_that_help_names(self):
        for page, command in (
            ("meniscusd.8", [MENISCUSD]),
            ("meniscus.1", [MENISCUS, "info"]),
            ("meniscus-load.1", [MENISCUS_LOAD]),
        ):
            named = set(re.findall(r"MENISCUS_[A-Z_]+", help_of(*command)))
            self.assertTrue(named, page)
            self.assertLessEqual(
                named, set(re.findall(r"^\.It Ev (MENISCUS_[A-Z_]+)", (PAGES / page).read_text(), re.MULTILINE)), page
            )

    def test_every_flag_that_a_text_mentions_exists(self):
        known = set(flags_of(help_of(MENISCUSD))) | set(flags_of(help_of(MENISCUS_LOAD))) | {"name"}
        overview = help_of(MENISCUS)
        for command in re.findall(r"^  ([a-z]+) {2,}\S", overview.partition("Subcommands:")[2], re.MULTILINE):
            known |= set(flags_of(help_of(MENISCUS, command)))
        for page in PAGES.iterdir():
            mentioned = set(re.findall(r"Fl -([a-z-]+)|(?<![\w-])--([a-z-]+)", page.read_text()))
            self.assertLessEqual({name for pair in mentioned for name in pair if name}, known, page.name)

    def test_every_setting_in_the_example_of_the_file_exists(self):
        example = re.search(
            r"^\.Bd -literal.*\n((?:.*\n)*?)\.Ed", (PAGES / "meniscus.conf.5").read_text(), re.MULTILINE
        ).group(1)
        names = {line.partition("=")[0].strip() for line in example.splitlines()}
        self.assertLessEqual(names, set(flags_of(help_of(MENISCUSD))))

    @unittest.skipUnless(shutil.which("mandoc"), "mandoc is not installed")
    def test_every_page_is_free_of_lint(self):
        for page in PAGES.iterdir():
            linted = subprocess.run(
                ["mandoc", "-Tlint", "-W", "warning", str(page)], capture_output=True, text=True, timeout=60
            )
            self.assertEqual((linted.returncode, linted.stdout), (0, ""), page.name)


if __name__ == "__main__":
    unittest.main()
