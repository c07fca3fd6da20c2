"""Files that are the frames of a sequence, by a pattern with {} in place of the number, as the command line has it."""

import os
import re
from dataclasses import dataclass
from math import floor, gcd


class SequenceError(ValueError):
    """A frame has no file, or a pattern names none. The message names the file."""


class MissingFile(SequenceError):
    """A sequence has no file of this number."""


@dataclass(frozen=True)
class Timing:
    """The number of the file that a frame of Blender's shows."""

    first: int  #: number of the first file
    last: int
    stride: int = 1  #: from one file's number to the next
    start: int = 1  #: the frame of Blender's that shows the first file
    speed: float = 1.0  #: files a frame: below 1, a file is held for several frames
    holds: bool = True  #: whether the first and the last file are held before and after the sequence

    def number(self, frame):
        """None: the frame is outside of the sequence, and nothing is held."""
        count = (self.last - self.first) // self.stride + 1
        index = floor((frame - self.start) * self.speed + 1e-6)
        if not 0 <= index < count and not self.holds:
            return None
        return self.first + min(max(index, 0), count - 1) * self.stride

    def end(self):
        """The last frame of Blender's that shows a file of its own."""
        return self.start + floor(((self.last - self.first) // self.stride) / self.speed)


def pattern_of(path):
    """The pattern of the sequence to which a file belongs; the path itself if no other file differs in a number alone.

    Of several numbers in a name, the one by which most files differ is the frame's, and the last of those.
    """
    folder, name = os.path.split(os.path.abspath(path))
    patterns = [
        os.path.join(folder, name[: found.start()] + "{}" + name[found.end() :]) for found in re.finditer(r"\d+", name)
    ]
    siblings = [(len(files(pattern)), place) for place, pattern in enumerate(patterns) if "{}" not in name]
    count, place = max(siblings, default=(0, 0))
    return patterns[place] if count > 1 else os.path.join(folder, name)


def files(pattern):
    """The files of a pattern by their numbers. Raises SequenceError for a folder that cannot be read."""
    folder, name = os.path.split(pattern)
    if name.count("{}") != 1:
        raise SequenceError(f"{pattern}: the name of the file needs one {{}} in place of the number")
    before, after = name.split("{}")
    found = {}
    try:
        for entry in os.scandir(folder):
            digits = entry.name[len(before) : len(entry.name) - len(after)]
            if digits.isascii() and digits.isdigit() and entry.name == before + digits + after:
                # If a folder has 7 and 007, the longer one is left out, in whatever order they are listed.
                known = found.get(int(digits))
                if known is None or len(entry.path) < len(known):
                    found[int(digits)] = entry.path
    except OSError as error:
        raise SequenceError(f"{folder}: {error.strerror}") from None
    return found


def path_of(pattern, number):
    """The file of a number. Raises SequenceError if it is not there."""
    if "{}" not in os.path.basename(pattern):
        if not os.path.isfile(pattern):
            raise SequenceError(f"{pattern} is not there")
        return pattern
    found = files(pattern)
    if number not in found:
        raise MissingFile(f"{pattern}: there is no file with the number {number}" + _range_text(found))
    return found[number]


def span(numbers):
    """(first, last, stride) of the numbers of files. The stride divides all distances."""
    ordered = sorted(numbers)
    stride = 0
    for earlier, later in zip(ordered, ordered[1:]):
        stride = gcd(stride, later - earlier)
    return ordered[0], ordered[-1], max(stride, 1)


def gaps_text(numbers):
    """Which numbers of a sequence have no file, in a sentence; "" where each has one."""
    first, last, stride = span(numbers)
    missing = sorted(set(range(first, last + 1, stride)) - set(numbers))
    if not missing:
        return ""
    listed = ", ".join(map(str, missing[:_MOST_LISTED])) + (", ..." if len(missing) > _MOST_LISTED else "")
    every = "" if stride == 1 else f" by {stride}"
    return f"{len(missing)} of the numbers {first} to {last}{every} have no file: {listed}"


#: Numbers that a sentence has.
_MOST_LISTED = 8


def _range_text(found):
    return f"; there are {len(found)}, from {min(found)} to {max(found)}" if found else "; no file matches"
