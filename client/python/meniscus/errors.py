"""The errors that this package raises by itself, and the category of its warnings."""


class Error(Exception):
    """The base of the errors below."""


class InvalidInput(Error, ValueError):
    """A setting, an array or a file is wrong. The message names the value and what is allowed."""


class LimitExceeded(Error):
    """The input is well formed but larger than a limit. The message names the value, the limit and what to do."""


class DeviceError(Error, RuntimeError):
    """A call to CUDA failed. ``device`` is the index of the GPU."""

    def __init__(self, message: str, device: int = 0) -> None:
        super().__init__(message)
        self.device = device


class ServerError(Error, RuntimeError):
    """The server is not there, refused the call, or went away.

    ``code`` is a name that stays from version to version, such as "unavailable", "not_found" or "canceled"; ``status``
    is gRPC's, such as "UNAVAILABLE", or "" for what this library has found wrong by itself.
    """

    def __init__(self, message: str, code: str = "unknown", status: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.status = status


class ForkedError(Error, RuntimeError):
    """The process was forked after it had used this package, whose threads do not survive that.

    Start worker processes by "spawn" or "forkserver" (``multiprocessing.set_start_method``), or fork before the first
    use.
    """


class SurfaceWarning(UserWarning):
    """A frame that was surely not meant so, such as a particle radius that does not fit the particles' spacing."""
