"""Flags with their defaults, as --help and the man pages have them."""

import re
import subprocess


def help_of(*command):
    return subprocess.run([*command, "--help"], check=True, capture_output=True, text=True, timeout=60).stdout


def flags_of(text):
    """Flag to default (None: it has none, or one that depends on the machine), as a --help has them."""
    flags = {}
    for option in re.findall(r"^  (-\S.*(?:\n {10}.*)*)", text, re.MULTILINE):
        names, left = re.match(r"(\S+)(.*)", option).groups()
        default = re.search(r"[A-Z\])}]=([^\s\[]+)", left)
        depends_on_machine = re.search(r"half\s+of\s+the\s+machine", option)
        has_default = default and "--no-" not in names and not depends_on_machine
        for name in re.findall(r"--([a-z-]+)", names):
            flags[name] = default.group(1) if has_default else None
    return flags


def items_of(source):
    """Flag to the text that describes it, of a part of a page."""
    items = {}
    for heads, text in re.findall(r"((?:^\.It Fl .*\n)+)((?:(?!^\.(?:It|El|Sh|Ss)\b).*\n)*)", source, re.MULTILINE):
        for flag in re.findall(r"Fl -([a-z-]+)", heads):
            assert flag not in items, f"--{flag} is there twice"
            items[flag] = text
    return items


def subsections_of(source):
    """Title to text, of every .Sh and .Ss."""
    parts = re.split(r"^\.S[hs] (.*)\n", source, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))
