"""The sessions of a server, fetched by a thread, for the list to choose from."""

import threading

from .worker import error_text


class SessionList:
    """One call of a server. connect: gives a meniscus.Client, or raises."""

    def __init__(self, connect):
        self.sessions = []  #: those of the server, once it is done
        self.error = ""
        self._connect = connect
        self._thread = threading.Thread(target=self._run, name="meniscus-sessions", daemon=True)
        self._thread.start()

    @property
    def done(self):
        return not self._thread.is_alive()

    def wait(self):
        self._thread.join()

    def _run(self):
        try:
            with self._connect() as client:
                self.sessions = client.sessions()
        except Exception as error:
            self.error = error_text(error)

    def entries(self):
        """(what chooses the session, what people read) of each: the name, or the id where several have the name."""
        names = [session.name for session in self.sessions]
        return [
            (
                session.name if session.name and names.count(session.name) == 1 else session.id,
                f"{session.name or session.id}, {session.frames} frames",
            )
            for session in self.sessions
        ]
