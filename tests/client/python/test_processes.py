"""The interpreter's end, forks, and memory that there is not."""

import pytest
from support.scripts import run_script

LEFT_OPEN = """
    import sys, threading
    import numpy as np, meniscus

    client = meniscus.Client(sys.argv[1])
    session = client.session(0.05)
    stream, watcher, particles = session.stream(), session.watch(), session.watch_particles()
    stream.push(np.random.random((2000, 3)))
    kept = watcher.next(60)
    meshes = [kept.mesh, meniscus.reconstruct(np.random.random((2000, 3)), 0.05)]
    views = [mesh.triangles for mesh in meshes]
    ready = threading.Barrier(4)

    def wait(call):
        ready.wait()
        while True:
            call()

    def compute():
        reconstructor.reconstruct(frame)

    reconstructor = meniscus.Reconstructor(0.05)
    frame = np.random.random((50000, 3)) * 4
    for call in stream.next, watcher.next, compute:
        threading.Thread(target=wait, args=(call,), daemon=True).start()
    ready.wait()
"""


@pytest.mark.parametrize("end", ["", "sys.exit(0)", "client.close()"])
def test_a_program_that_leaves_everything_open_ends_well(end, server):
    assert run_script(LEFT_OPEN + "    " + end, server.address) == (0, "", "")


def test_a_program_that_ends_by_an_exception_says_that_alone(server):
    code, out, err = run_script(LEFT_OPEN + "    1 / 0", server.address)
    assert code == 1 and err.rstrip().endswith("ZeroDivisionError: division by zero")


def test_a_program_ends_well_while_its_threads_have_errors(server):
    # One makes its error for as long as it may: Python unwinds it where it waits for the interpreter's lock.
    script = """
        import sys, threading, time, meniscus

        client = meniscus.Client(sys.argv[1])
        is_made = threading.Event()

        def make(self, *arguments):
            is_made.set()
            while True:
                pass

        def fail():
            try:
                client.session_info("00000000-0000-4000-8000-000000000000")
            except meniscus.ServerError as error:
                assert (error.code, error.status) == ("not_found", "NOT_FOUND")

        sys.setswitchinterval(1e-4)
        meniscus.ServerError.__init__ = make
        failing = threading.Thread(target=fail, daemon=True)
        failing.start()
        while failing.is_alive() and not is_made.is_set():
            time.sleep(0.01)
    """
    assert run_script(script, server.address) == (0, "", "")


def test_importing_starts_no_thread():
    code, out, err = run_script("import os, meniscus; print(len(os.listdir('/proc/self/task')))")
    assert (code, out, err) == (0, "1\n", "")


FORK = """
    import os, sys
    import numpy as np, meniscus

    positions = np.random.default_rng(1).random((2000, 3))
    reconstructor = meniscus.Reconstructor(0.05)
    mesh = reconstructor.reconstruct(positions)
    client = meniscus.Client(sys.argv[1])
    session = client.session(0.05)
    stream = session.stream()
    watcher = session.watch()
    stream.push(positions)
    child = os.fork()
    if child == 0:
        calls = [
            lambda: meniscus.reconstruct(positions, 0.05),
            lambda: meniscus.Reconstructor(0.05),
            lambda: reconstructor.reconstruct(positions),
            lambda: reconstructor.coarser(1),
            lambda: meniscus.Client(sys.argv[1]),
            client.info,
            client.sessions,
            lambda: client.session(0.05),
            lambda: stream.push(positions),
            lambda: stream.next(0),
            lambda: watcher.next(),
            lambda: session.watch(),
        ]
        for number, call in enumerate(calls):
            try:
                call()
            except meniscus.ForkedError as error:
                assert "spawn" in str(error)
            else:
                print("call", number, "did not raise", flush=True)
        assert len(mesh.triangles) > 0 and np.isfinite(mesh.vertices).all()
        {end}
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert stream.next(60).index == 0 and watcher.next(60).index == 0
    assert reconstructor.reconstruct(positions).sha256() == mesh.sha256()
    stream.push(positions)
    assert stream.next(60).index == 1
    assert session.info().frames == 2
"""


@pytest.mark.parametrize("end", ["sys.exit(0)", "os._exit(0)", "del stream, watcher, session, client; sys.exit(0)"])
def test_a_forked_child_is_refused_and_its_parent_goes_on(end, server):
    code, out, err = run_script(FORK.replace("{end}", end), server.address)
    assert (code, out, err) == (0, "", "")


def test_a_child_that_was_forked_before_the_first_use_may_do_everything(server):
    code, out, err = run_script(
        """
        import os, sys
        import numpy as np, meniscus

        child = os.fork()
        mesh = meniscus.reconstruct(np.random.default_rng(1).random((2000, 3)), 0.05)
        assert len(mesh.triangles) > 0 and meniscus.Client(sys.argv[1]).serving()
        if child:
            assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        """,
        server.address,
    )
    assert (code, out, err) == (0, "", "")


def test_spawned_workers_compute_beside_their_parent(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        """
import multiprocessing
import numpy as np, meniscus

def surface(seed):
    return meniscus.reconstruct(np.random.default_rng(seed).random((500, 3)), 0.05).sha256()

if __name__ == "__main__":
    expected = [surface(seed) for seed in range(2)]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(surface, range(2)) == expected
    print("done")
"""
    )
    code, out, err = run_script("import runpy, sys; runpy.run_path(sys.argv[1], run_name='__main__')", program)
    assert (code, out, err) == (0, "done\n", "")


def test_memory_that_there_is_not_is_an_error_and_no_end():
    code, out, err = run_script(
        """
        import resource
        import numpy as np, meniscus

        small = np.random.default_rng(1).random((500, 3), np.float32)
        large = np.random.default_rng(1).random((1000000, 3), np.float32) * 10
        reconstructor = meniscus.Reconstructor(0.05, threads=1)
        expected = reconstructor.reconstruct(small).sha256()
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + (60 << 20), resource.RLIM_INFINITY))
        try:
            reconstructor.reconstruct(large)
        except (MemoryError, meniscus.LimitExceeded):
            print("refused")
        resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        assert reconstructor.reconstruct(small).sha256() == expected
        """
    )
    assert (code, out, err) == (0, "refused\n", "")


def test_a_program_without_a_server_needs_none():
    code, out, err = run_script(
        """
        import meniscus
        help_text = meniscus.__doc__
        assert "reconstruct" in help_text and meniscus.Client.__doc__
        for name in meniscus.__all__:
            assert getattr(meniscus, name) is not None
        """
    )
    assert (code, out, err) == (0, "", "")
