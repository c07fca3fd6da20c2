"""Ctrl-C, pressed when the main thread waits in a call."""

import os
import signal
import sys
import threading
from contextlib import contextmanager

import meniscus

#: Looks at the main thread in a row that must find it at the same instruction, so that it surely is in the call. With
#: the interpreter's lock held in there, no other thread would get to look at all.
looks = 20
package = os.path.dirname(meniscus.__file__)


class MainThread:
    """Watches, from another thread, whether the main thread is in a call out of the function ``name``."""

    def __init__(self, name):
        self._name = name
        self._main = threading.main_thread().ident

    def _place(self):
        frame = sys._current_frames().get(self._main)
        if frame is None or frame.f_code.co_name != self._name or not frame.f_code.co_filename.startswith(package):
            return None
        return id(frame), frame.f_lasti

    def is_waiting(self, over):
        """Returns True once it is; False when ``over`` is set before."""
        same, last = 0, None
        while not over.wait(0.002):
            place = self._place()
            same = same + 1 if place is not None and place == last else 0
            last = place
            if same >= looks:
                return True
        return False


@contextmanager
def ctrl_c_in(name):
    """Interrupts the process once the main thread is in a call out of the package's function ``name``."""
    over, lock = threading.Event(), threading.Lock()

    def interrupt():
        if MainThread(name).is_waiting(over):
            with lock:
                if not over.is_set():
                    os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        yield
    finally:
        with lock:
            over.set()
        thread.join()
