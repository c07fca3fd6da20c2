"""A meniscusd, or another program, that runs while a test does."""

import re
import subprocess
import threading


class Running:
    """A process whose standard error is read line by line; killed at the end."""

    def __init__(self, command, **options):
        self.lines = []
        self._changed = threading.Condition()
        self.process = subprocess.Popen(
            [str(word) for word in command],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            **options,
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        for line in self.process.stderr:
            with self._changed:
                self.lines.append(line)
                self._changed.notify_all()
        with self._changed:
            self.lines.append("")  # the end
            self._changed.notify_all()

    def wait_for(self, pattern):
        """The match of the first line that has one."""

        def found():
            return next((m for m in (re.search(pattern, line) for line in self.lines) if m), None)

        with self._changed:
            self._changed.wait_for(lambda: found() or "" in self.lines, timeout=60)
            match = found()
        if not match:
            raise AssertionError(f"no line with {pattern} in:\n" + "".join(self.lines))
        return match

    def stop(self):
        self.process.kill()
        self.process.wait()
        self._reader.join()
        self.process.stderr.close()


class Server(Running):
    """meniscusd on ports that the kernel chooses."""

    def __init__(self, meniscusd, *arguments, **options):
        super().__init__(
            [
                meniscusd,
                "--listen",
                "127.0.0.1:0",
                "--http",
                "127.0.0.1:0",
                "--backend",
                "cpu",
                "--threads",
                "1",
                *arguments,
            ],
            **options,
        )
        self.address = self.wait_for(r"listening on (127\.0\.0\.1:\d+)")[1]
        self.http = self.wait_for(r"https?://(127\.0\.0\.1:\d+)")[1]
