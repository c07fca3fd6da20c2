"""The lines of the tables."""

from dataclasses import dataclass
from typing import Any, Callable


@dataclass(frozen=True)
class Wrong:
    name: str
    call: Callable[[Any], Any]  #: of the object that is to refuse
    error: Any  #: a class, or several
    words: tuple  #: regular expressions, each of which is found in the message


def wrong(name, call, error, *words):
    return Wrong(name, call, error, words)
