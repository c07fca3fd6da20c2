"""Keywords as the texts in which the library takes its options: one reader of them serves C, C++ and Python."""

from __future__ import annotations

import os
from typing import Any, Mapping, Sequence, Union

from .errors import InvalidInput
from .named import array_name

#: Of a session's attributes those that meshes have: "all", their names, or names with bits (0: exact).
AttributeRequest = Union[str, Sequence[str], Mapping[str, int]]


def option_texts(keywords: Mapping[str, Any]) -> dict[str, str]:
    """Values by option name. None is left out."""
    for name in keywords:
        if not name.isidentifier():  # "particle-radius" would come beside particle_radius
            raise InvalidInput(f"the keyword {name!r} is not known here, must be a name such as particle_radius")
    return {name.replace("_", "-"): _text(name, value) for name, value in keywords.items() if value is not None}


def names_text(names: Union[str, Sequence[str]]) -> str:
    """Names of arrays, or "all"."""
    if isinstance(names, Mapping):
        raise InvalidInput(f"attributes is {names!r}, must be 'all', a name, or names: bits are for those who receive")
    try:
        return " ".join(_name(name) for name in ([names] if isinstance(names, str) else names))
    except TypeError:
        raise InvalidInput(f"attributes is {names!r}, must be 'all', a name, or names") from None


def attribute_text(request: AttributeRequest) -> str:
    """Attributes as a receiver asks for them: "velocity:12 age"."""
    if isinstance(request, Mapping):
        return " ".join(f"{_name(name)}:{_text('attribute_bits', bits)}" for name, bits in request.items())
    return names_text(request)


def _name(name: Any) -> str:
    if not isinstance(name, str) or not name.isprintable() or ":" in name or not name.strip():
        raise InvalidInput(f"the attribute name {name!r} must be of a-z, 0-9 and _")
    if len(name.encode()) > _LONGEST_NAME:
        raise InvalidInput(f"the attribute name {name[:_LONGEST_NAME]!r}... must be of at most {_LONGEST_NAME} bytes")
    return array_name(name)


#: Bytes of a name of an array.
_LONGEST_NAME = 64


def _text(name: str, value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return _sendable(name, os.fsdecode(value))
    if isinstance(value, (bytes, bytearray)):  # which would do as numbers; not shown, for it may be a token
        raise InvalidInput(f"{name} is of type {type(value).__name__}, must be a text, a number, or numbers")
    try:
        if getattr(value, "ndim", None) == 0:  # numpy's numbers, and arrays of one
            value = value.item()
        if hasattr(value, "__index__") and not hasattr(value, "__len__"):
            return str(value.__index__())
        if hasattr(value, "__float__") and not hasattr(value, "__len__"):
            return repr(float(value))
        return " ".join(repr(float(number)) for number in _flat(value))
    except (TypeError, ValueError, OverflowError):
        raise InvalidInput(f"{name} is {value!r}, must be a text, a number, or numbers") from None


def _sendable(name: str, text: str) -> str:
    """Raises InvalidInput, without the text, which may be a token."""
    if "\0" in text or any("\ud800" <= character <= "\udfff" for character in text):
        raise InvalidInput(f"{name} has a character that UTF-8 cannot hold, or a zero byte")
    return text


def _flat(values: Any) -> list[Any]:
    """The numbers of values one by one: (min, max) of a box gives six."""
    flat: list[Any] = []
    for value in values:
        flat.extend(value) if hasattr(value, "__len__") and not isinstance(value, str) else flat.append(value)
    return flat
