"""A server of this program's own."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import threading
import weakref
from collections import deque
from pathlib import Path
from typing import IO, Optional, Sequence, Union

from .client import Client
from .errors import InvalidInput, ServerError

#: The server ends when this input does: also where the program is killed that holds its other end.
_UNTIL_INPUT_ENDS = '"$@" & exec 2>&-; read _; kill $!; wait $!'
#: Seconds in which the server must be there, or gone. It takes a fraction of one.
_PATIENCE = 30.0


class Server:
    """A ``meniscusd`` on free ports of this machine alone: ``with meniscus.Server() as client: ...``.

    The server listens once this is made, and ends with the block, with close(), or with the program. ``flags`` are
    those of meniscusd, such as "--record", "FOLDER". program: its path; None: the one that is installed beside this
    package, or found on PATH. pages: origins that may show the viewer in a frame, as show() does; by default those of
    Jupyter on this machine.

    Raises InvalidInput where there is no program, ServerError with the server's words where it does not start.
    """

    def __init__(
        self,
        *flags: str,
        program: Optional[Union[str, os.PathLike[str]]] = None,
        pages: Sequence[str] = ("http://localhost:8888", "http://127.0.0.1:8888"),
    ) -> None:
        command = [_program(program), "--listen", "127.0.0.1:0", "--http", "127.0.0.1:0", *flags]
        if pages:
            command += ["--web-frame-ancestors", ",".join(pages)]
        self.address = ""  #: for Client
        self.viewer = ""  #: the viewer's page
        self.log: deque[str] = deque(maxlen=1000)  #: the last lines of the server's log
        self._told = threading.Event()
        self._process = subprocess.Popen(
            ["sh", "-c", _UNTIL_INPUT_ENDS, "sh", *command],
            stdin=subprocess.PIPE,
            stderr=subprocess.PIPE,
            # Its settings are the flags alone: it refuses a variable of this name that it does not know.
            env={name: value for name, value in os.environ.items() if not name.startswith("MENISCUS_")},
            text=True,
            errors="replace",
            start_new_session=True,  # Ctrl-C is meant for this program
        )
        assert self._process.stderr is not None
        reader = threading.Thread(target=_read, args=(weakref.ref(self), self._process.stderr), daemon=True)
        reader.start()
        self._end = weakref.finalize(self, _end, self._process, reader)
        if not self._told.wait(_PATIENCE) or not self.viewer:
            self.close()
            said = next((line for line in reversed(self.log) if line), "it has said nothing")
            raise ServerError(f"{command[0]} does not start: {said}", "unavailable")

    def client(self) -> Client:
        """A connection to it."""
        client = Client(self.address)
        client.viewer = self.viewer
        return client

    def close(self) -> None:
        """Ends the server; it finishes the frames that it has."""
        self._end()

    def __enter__(self) -> Client:
        self._client = self.client()
        return self._client

    def __exit__(self, *_: object) -> None:
        self._client.close()
        self.close()

    def __repr__(self) -> str:
        return f"<meniscus.Server {self.address}{'' if self._end.alive else ', ended'}>"

    def _take(self, line: str) -> None:
        self.log.append(line.rstrip())
        if found := re.search(r" listening on (\S+?), ", line):
            self.address = found[1]
        if found := re.search(r" at (http://\S+)$", line):
            self.viewer = found[1]
            self._told.set()


def _program(given: Optional[Union[str, os.PathLike[str]]]) -> str:
    if given is not None:
        return os.fspath(given)
    package = Path(__file__).resolve().parent
    in_build, below_prefix = "../../../server/meniscusd", "../../../../bin/meniscusd"
    for place in in_build, below_prefix:
        path = os.path.normpath(package / place)
        if os.access(path, os.X_OK):
            return path
    if (found := shutil.which("meniscusd")) is None:
        raise InvalidInput("there is no meniscusd on PATH: install it, or give its path as program")
    return found


def _read(server: weakref.ref[Server], lines: IO[str]) -> None:
    """The reader keeps the server alive for no longer than a line takes."""
    with lines:
        for line in lines:
            if (one := server()) is not None:
                one._take(line)
            del one
    if (one := server()) is not None:
        one._told.set()


def _end(process: subprocess.Popen[str], reader: threading.Thread) -> None:
    if process.stdin is not None:
        process.stdin.close()
    try:
        process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    if reader is not threading.current_thread():  # which may be the last that refers to the server
        reader.join()
