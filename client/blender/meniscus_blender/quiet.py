"""Changes of settings by code, which show nothing at once."""

from contextlib import contextmanager

_quiet = False


@contextmanager
def quiet():
    """Settings that change within it show nothing: what is then to be shown is the caller's affair."""
    global _quiet
    before, _quiet = _quiet, True
    try:
        yield
    finally:
        _quiet = before


def is_quiet():
    return _quiet
