"""A real meniscusd in a process of its own."""

import os
import re
import signal
import subprocess
import threading

from .programs import environment_of_programs

program = os.environ.get("MENISCUSD", "")
#: Seconds within which a server must be there, or gone. Far more than it takes: the machine may be busy.
deadline = 60


class Server:
    """Listens on a Unix socket in ``folder``, or where ``listen`` says; its log goes to ``log``."""

    def __init__(self, folder, *flags, listen=None):
        self._command = [program, "--listen", listen or f"unix:{folder}/server", "--http", "off", *map(str, flags)]
        self.log = []
        self.address = None
        self.start()

    def start(self):
        """Also once more, at the same address."""
        if self.address is not None:
            self._command[2] = self.address
        self._listening = threading.Event()
        self._process = subprocess.Popen(
            self._command, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True, env=environment_of_programs()
        )
        self._reader = threading.Thread(target=self._read, args=(self._process.stderr,), daemon=True)
        self._reader.start()
        if not self._listening.wait(deadline) or self._process.poll() is not None:
            self.kill()
            raise RuntimeError(f"{self._command} does not listen:\n" + "".join(self.log))

    def _read(self, lines):
        for line in lines:
            self.log.append(line)
            if found := re.search(r"listening on (\S+?),", line):
                self.address = found[1]
                self._listening.set()
        self._listening.set()
        lines.close()

    def kill(self):
        """Ends the server as a crash would."""
        self._process.kill()
        self._process.wait(deadline)
        self._reader.join(deadline)

    def halt(self):
        """Returns when it runs no more; it keeps its connections."""
        self._process.send_signal(signal.SIGSTOP)
        os.waitid(os.P_PID, self._process.pid, os.WSTOPPED)

    def go_on(self):
        self._process.send_signal(signal.SIGCONT)

    def stop(self):
        self._process.terminate()
        try:
            self._process.wait(deadline)
        except subprocess.TimeoutExpired:
            self._process.kill()
            raise
        self._reader.join(deadline)

    def is_running(self):
        return self._process.poll() is None
