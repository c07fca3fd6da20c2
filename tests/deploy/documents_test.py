"""Links and paths of the documents, and what the documents promise of themselves: documents_test.py REPOSITORY."""

import re
import subprocess
import sys
import unittest
from pathlib import Path

REPOSITORY = Path(sys.argv.pop()).resolve()
GENERATED = {".build", ".git", "node_modules", "out"}
ROOMS = ("core", "proto", "server", "client", "tests", "deploy", ".github")


def files_named(pattern, folder=REPOSITORY):
    """Files of the repository: nothing generated."""
    for path in sorted(folder.iterdir()):
        if path.is_dir() and not path.is_symlink() and path.name not in GENERATED:
            yield from files_named(pattern, path)
        elif path.is_file() and path.match(pattern):
            yield path


FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def prose_of(page):
    """Its text without fenced code, in which brackets are no links."""
    return FENCED.sub("", page.read_text())


def code_of(page):
    """Its texts in backticks, fenced or within a line."""
    return FENCED.findall(page.read_text()) + re.findall(r"`[^`\n]+`", prose_of(page))


def anchors_of(page):
    """The anchors that GitHub gives the headings of a page."""
    anchors = set()
    for heading in re.findall(r"^#{1,6} +(.*?) *$", prose_of(page), re.MULTILINE):
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        anchor = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        names = (anchor if number == 0 else f"{anchor}-{number}" for number in range(len(anchors) + 1))
        anchors.add(next(name for name in names if name not in anchors))
    return anchors


def name(path):
    return str(path.relative_to(REPOSITORY))


class Documents(unittest.TestCase):
    def assert_leads_somewhere(self, origin, target):
        """target: as a link of the file `origin` has it."""
        path, _, anchor = target.partition("#")
        page = (origin.parent / path).resolve() if path else origin
        self.assertTrue(page.is_relative_to(REPOSITORY), f"{name(origin)} links out of the repository: {target}")
        self.assertTrue(page.exists(), f"{name(origin)} links to {target}, which is not there")
        if anchor:
            self.assertIn(anchor, anchors_of(page), f"{name(origin)} links to {target}: no such heading")

    def test_every_relative_link_leads_to_a_file_and_to_a_heading_of_it(self):
        links = 0
        for page in files_named("*.md"):
            prose = re.sub(r"`[^`\n]*`", "", prose_of(page))
            for target in re.findall(r"\]\(([^()\s]+)\)", prose):
                if not re.match(r"[a-z]+:", target):
                    with self.subTest(target):
                        self.assert_leads_somewhere(page, target)
                    links += 1
        self.assertGreater(links, 100)

    def test_every_path_in_backticks_exists(self):
        # The changelog names files of earlier versions, results those of the commit that was measured.
        pages = {
            *files_named("README.md"),
            *files_named("CONTRIBUTING.md"),
            *files_named("*.md", REPOSITORY / "deploy"),
        }
        rooms = "|".join(map(re.escape, ROOMS))
        paths = 0
        for page in sorted(pages):
            for code in code_of(page):
                for path in re.findall(rf"(?<![\w./$-])(?:{rooms})/[\w./-]*", code):
                    with self.subTest(path):
                        self.assertTrue((REPOSITORY / path).exists(), f"{name(page)} names {path}, which is not there")
                    paths += 1
        self.assertGreater(paths, 30)

    def test_every_heading_that_a_comment_cites_exists(self):
        for pattern in ("*.hpp", "*.cpp", "*.cu", "*.c", "*.h", "*.proto"):
            for source in files_named(pattern):
                for page, anchor in re.findall(r"([\w./]+README\.md)#([\w-]+)", source.read_text()):
                    cited = REPOSITORY / page
                    self.assertTrue(cited.is_file(), f"{name(source)} cites {page}, which is not there")
                    self.assertIn(anchor, anchors_of(cited), f"{name(source)} cites {page}#{anchor}: no such heading")

    def test_every_recipe_names_the_files_of_one_that_exists(self):
        """The example of a section "A ..., such as `example`" is in every file that its numbered list links."""
        page = REPOSITORY / ".github/CONTRIBUTING.md"
        sections = re.findall(
            r"^## (An? [\w ]+)\n\n[^`]*?such\s+as\s+`(\w+)`(.*?)(?=^## )", page.read_text(), re.M | re.S
        )
        self.assertEqual(
            {"A setting", "A statistic", "A limit", "A file format", "An attribute type"},
            {title for title, *_ in sections},
        )
        for title, example, text in sections:
            items = re.findall(r"^\d\. .*(?:\n   .*)*", text, re.MULTILINE)
            files = [link.partition("#")[0] for item in items for link in re.findall(r"\]\(([^()\s]+)\)", item)]
            self.assertGreater(len(files), 2, title)
            for file in files:
                found = (page.parent / file).resolve().read_text().lower().replace("-", "_")
                self.assertIn(example, found, f"{title}: {file} has no {example}")

    def test_what_is_written_by_hand_knows_the_rows(self):
        """The struct of the C interface and Blender's panel, which choose, against what is written from the rows."""

        def rows(page, pattern):
            place = re.search(
                r" rows: (?:settings|statistics)\b.*?\n(.*?) end of rows", (REPOSITORY / page).read_text(), re.S
            )
            return set(re.findall(pattern, place.group(1), re.MULTILINE))

        header = (REPOSITORY / "client/c/include/meniscus/meniscus.h").read_text()
        struct = re.search(r"typedef struct meniscus_statistics \{(.*?)\}", header, re.DOTALL).group(1)
        members = set(re.findall(r"^ +\w+ (\w+)(?:\[\d\])?;", struct, re.MULTILINE))
        statistics = rows("client/python/meniscus/statistics.py", r"^ +(\w+): ")
        self.assertEqual(
            statistics - members,
            {
                "allocations",
                "backend",
                "base_cells_by_level",
                "device_peak_bytes",
                "download_seconds",
                "threads",
                "warnings",
            },
        )
        panel = (REPOSITORY / "client/blender/meniscus_blender/sequence_objects.py").read_text()
        keywords = re.search(r"keywords = \{(.*?)return keywords", panel, re.DOTALL).group(1)
        settings = rows("client/README.md", r"^\| `--([\w-]+)`")
        shown = set(re.findall(r'"(\w+)"(?:\] =|: )', keywords)) - {"preset"}
        self.assertGreater(len(shown), 3)
        self.assertLessEqual(shown, {name.replace("-", "_") for name in settings})

    def test_the_lines_that_find_the_programs_name_the_folders_in_which_they_are_built(self):
        lines = subprocess.run([REPOSITORY / "deploy/paths"], capture_output=True, text=True, check=True).stdout
        path = re.search(r"^export PATH=(.*):\$PATH$", lines, re.MULTILINE).group(1)
        folders = [folder.partition("/.build/release/")[2] for folder in path.split(":")]
        for folder, program in zip(folders, ("meniscus", "meniscusd"), strict=True):
            built = (REPOSITORY / folder / "CMakeLists.txt").read_text()
            self.assertIn(f"add_executable({program} ", built)
        self.assertIn('\neval "$(deploy/paths)"', (REPOSITORY / "README.md").read_text())
        for script in ("demo", "test"):
            self.assertIn("\ndeploy/paths ", (REPOSITORY / "deploy" / script).read_text())

    def test_the_front_page_is_short(self):
        self.assertLessEqual(len((REPOSITORY / "README.md").read_text().splitlines()), 150)

    def test_every_room_has_a_page_that_the_front_page_links(self):
        front = (REPOSITORY / "README.md").read_text()
        for room in ("core", "proto", "server", "client", "client/python", "client/web", "deploy", "tests"):
            self.assertIn(f"({room}/README.md)", front)


if __name__ == "__main__":
    unittest.main()
