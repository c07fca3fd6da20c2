"""The completion of the command line against its help: completion_test.py MENISCUS BASH-SCRIPT ZSH-SCRIPT.

The scripts are those that the package installs."""

import re
import shlex
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from flags import flags_of, help_of

*_, MENISCUS, BASH_SCRIPT, ZSH_SCRIPT = sys.argv
del sys.argv[1:]


def commands():
    return re.findall(r"^  ([a-z]+) {2,}\S", help_of(MENISCUS).partition("Subcommands:")[2], re.MULTILINE)


def choices_of(help_text):
    """Flag to the names that it takes."""
    shown = re.findall(r"^  (?:-\w,)?(--[a-z-]+) [A-Z]+:\{([^}]*)\}", help_text, re.MULTILINE)
    return {flag: names.split(",") for flag, names in shown}


class Bash(unittest.TestCase):
    def completions(self, *words):
        """The completions of the last word, which may be empty."""
        script = (
            'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _meniscus; printf "%s\\n" "${COMPREPLY[@]}"'
        )
        run = subprocess.run(
            ["bash", "-euc", script, "bash", BASH_SCRIPT, "meniscus", *words],
            check=True,
            capture_output=True,
            text=True,
            timeout=60,
        )
        self.assertEqual(run.stderr, "")
        return run.stdout.split()

    def test_offers_every_command(self):
        self.assertGreater(len(commands()), 10)
        self.assertEqual({word for word in self.completions("") if word[0] != "-"}, set(commands()))
        self.assertEqual(self.completions("rec"), [name for name in commands() if name.startswith("rec")])

    def test_offers_exactly_the_flags_of_each_command_and_their_choices(self):
        for command in commands():
            text = help_of(MENISCUS, command)
            offered = {word[2:] for word in self.completions(command, "-") if word.startswith("--")}
            self.assertEqual(offered, set(flags_of(text)), command)
            for flag, names in choices_of(text).items():
                self.assertEqual(self.completions(command, flag, ""), names, f"{command} {flag}")
        self.assertEqual(self.completions("reconstruct", "--field", "sm"), ["smooth"])

    def test_offers_commands_to_help_and_files_to_others(self):
        self.assertEqual(set(self.completions("help", "")) | {"help"}, set(commands()))
        self.assertEqual(self.completions("picture", ""), [])  # then bash offers files
        self.assertIn("complete -o default -F _meniscus meniscus\n", Path(BASH_SCRIPT).read_text())


class Zsh(unittest.TestCase):
    def test_has_every_flag_of_each_command_and_its_choices(self):
        script = Path(ZSH_SCRIPT).read_text()
        self.assertTrue(script.startswith("#compdef meniscus\n"))
        parts = dict(re.findall(r"^        ([a-z]+)\)\n(.*?)^            ;;$", script, re.MULTILINE | re.DOTALL))
        self.assertEqual(sorted(parts), sorted(commands()))
        for command, part in parts.items():
            # Quotes and continued lines are those of every shell.
            words = " ".join(shlex.split(part.replace("\\\n", " ")))
            text = help_of(MENISCUS, command)
            self.assertEqual(set(re.findall(r"--([a-z-]+)[[,})]", words)), set(flags_of(text)), command)
            for names in choices_of(text).values():
                self.assertIn(f"({' '.join(names)})", words)

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_is_a_script_of_zsh(self):
        subprocess.run(["zsh", "-n", ZSH_SCRIPT], check=True, timeout=60)


class Examples(unittest.TestCase):
    def test_of_help_use_flags_that_exist(self):
        for command in commands():
            examples = help_of(MENISCUS, command).partition("Examples:\n")[2]
            self.assertTrue(examples, command)
            for name, arguments in re.findall(r"meniscus ([a-z]+)([^|\n)]*)", examples):
                self.assertIn(name, commands())
                used = {word[2:] for word in shlex.split(arguments) if word.startswith("--")}
                self.assertLessEqual(used, set(flags_of(help_of(MENISCUS, name))), f"{name}{arguments}")


if __name__ == "__main__":
    unittest.main()
