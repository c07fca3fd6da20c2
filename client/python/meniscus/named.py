"""Arrays by name, where a name has two forms: that of a file, and the one in which arrays travel."""

from __future__ import annotations

from typing import Any, Dict, Optional, TypeVar

from . import _meniscus

T = TypeVar("T")


def array_name(name: str) -> str:
    """The name by which an array travels: of a-z, 0-9 and _, as ``temperature__k_`` of "Temperature (K)"."""
    return _meniscus.array_name(name)


class Named(Dict[str, T]):
    """Values by the names of arrays. The name that a file has for an array finds its value, too."""

    def __missing__(self, key: str) -> T:
        if (name := self._name_of(key)) is None:
            raise KeyError(f"{key!r}; there are: {', '.join(self) or 'none'}")
        return self[name]

    def __contains__(self, key: object) -> bool:
        return self._name_of(key) is not None

    def get(self, key: str, default: Any = None) -> Any:
        name = self._name_of(key)
        return default if name is None else self[name]

    def _name_of(self, key: Any) -> Optional[str]:
        """The key under which the value is; None where there is none."""
        if not isinstance(key, str) or super().__contains__(key):
            return key if isinstance(key, str) else None
        name = array_name(key)
        return name if super().__contains__(name) else None
