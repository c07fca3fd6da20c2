"""The examples that the documents name, each as a user runs it, against a real server."""

import ast
import json
import pathlib
import re
import subprocess
import sys

import numpy as np

from support import command_line
from support.programs import environment_of_programs

repository = pathlib.Path(__file__).parents[3]
examples = repository / "client" / "python" / "examples"


def lines_of(example, *arguments, **options):
    """The lines that the example prints. Warnings are errors."""
    command = [sys.executable, "-B", "-W", "error", examples / example, *map(str, arguments)]
    ran = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120, **options)
    assert (ran.returncode, ran.stderr) == (0, "")
    return ran.stdout.splitlines()


def test_the_toy_simulator_gets_a_surface_for_each_frame(server):
    lines = lines_of("numpy_simulator.py", server.address)
    frames = [re.fullmatch(r"frame (\d+): (\d+) triangles, volume ([\d.]+)", line).groups() for line in lines]
    assert [int(index) for index, _, _ in frames] == list(range(100))
    assert all(int(triangles) > 100 for _, triangles, _ in frames)
    assert 0.4 < float(frames[0][2]) < 0.6  # of 4096 particles of 5 cm


def test_the_toy_simulator_has_help_and_needs_no_server_for_it():
    assert "ADDRESS" in "\n".join(lines_of("numpy_simulator.py", "--help")).upper()


def test_the_session_of_the_toy_simulator_stays_to_be_looked_at(server, client):
    """The process is ended once its session has rested with the last frame in it."""
    command = [sys.executable, "-B", examples / "numpy_simulator.py", server.address, "--stay", "600"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True) as running:
        try:
            assert sum(1 for _ in zip(range(100), running.stdout)) == 100
            found = client.session_info("numpy")
            assert found.uploading and found.frames == 100 and running.poll() is None
        finally:
            running.kill()


def test_the_loop_with_a_callback_takes_or_leaves_every_step(server, tmp_path):
    *steps, counts, last = lines_of("callback_loop.py", server.address, tmp_path / "last.npz")
    left_out, dropped = map(int, re.fullmatch(r"(\d+) steps were left out, (\d+) dropped", counts).groups())
    indices = [int(re.fullmatch(r"step (\d+): [1-9]\d+ triangles", step).group(1)) for step in steps]
    assert indices == sorted(set(indices))
    assert len(indices) + left_out + dropped == 200
    assert "velocity" in last
    assert len(np.load(tmp_path / "last.npz")["velocity"]) > 100


def test_a_surface_that_is_made_by_the_program_is_published(server):
    lines = lines_of("own_surface.py", server.address)
    answers = [re.fullmatch(r"frame (\d+): ([1-9]\d+) triangles", line).group(1) for line in lines]
    assert [int(index) for index in answers] == list(range(20))


def test_frames_made_with_numpy_alone_come_through_a_pipe(server):
    command = [sys.executable, "-B", "-W", "error", examples / "piped_frames.py"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) as frames:
        push = [command_line.program, "push", "-", "--server", server.address, "--answers", "-", "-q"]
        pushed = subprocess.run(
            [*push, "-r", "0.025", "--attribute", "speed"],
            stdin=frames.stdout,
            capture_output=True,
            text=True,
            env=environment_of_programs(),
            timeout=120,
        )
    assert (pushed.returncode, pushed.stderr, frames.returncode) == (0, "", 0)
    session, *answers, end = map(json.loads, pushed.stdout.splitlines())
    assert [answer["frame"] for answer in answers] == list(range(20))
    assert all(answer["particles"] == 4096 and answer["triangles"] > 100 for answer in answers)
    assert answers[3]["simulation_time"] == 3 * 0.01
    assert end == {"ended": True, "dropped": 0}


def test_the_notebook_runs_without_jupyter(server, monkeypatch, tmp_path):
    """Its cells one after the other, without the plot, which needs matplotlib."""
    monkeypatch.setenv("SERVER", server.address)
    monkeypatch.chdir(tmp_path)
    cells = json.loads((examples / "live_plot.ipynb").read_text())["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] for cell in cells if cell["cell_type"] == "code"), "kept with outputs"
    names = {}
    for cell in code:
        for statement in ast.parse(cell).body:
            text = ast.unparse(statement)
            if not re.search(r"matplotlib|\b(figure|axis)\b", text):
                exec(compile(text, "live_plot.ipynb", "exec"), names)
    assert len(names["frames"]) == 100
    assert (tmp_path / "live_plot.glb").read_bytes().startswith(b"glTF")
    names["session"].end()


def snippets(document):
    return re.findall(r"^```python\n(.*?)^```", document.read_text(), re.MULTILINE | re.DOTALL)


def test_every_snippet_of_the_documents_is_python():
    found = 0
    for document in ("README.md", "client/README.md", "client/python/README.md"):
        for snippet in snippets(repository / document):
            # "async for" stands alone there.
            compile(snippet, document, "exec", flags=ast.PyCF_ALLOW_TOP_LEVEL_AWAIT)
            found += 1
    assert found > 5


def test_the_first_snippets_of_the_page_do_what_they_say(server, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    in_process, _, through_a_server, *_ = snippets(repository / "client" / "python" / "README.md")
    names = {}
    exec(in_process, names)
    assert (tmp_path / "water.glb").stat().st_size > 1000
    exec(through_a_server.replace("127.0.0.1:50051", server.address), names)
    assert names["frame"].index == 99
