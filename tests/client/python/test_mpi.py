"""The ranks of an MPI job, which make one surface (meniscus.mpi)."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import uuid

import meniscus
import pytest
from support.falling import marks_of, particle_radius, particles_of

pytest.importorskip("mpi4py")
mpirun = shutil.which("mpirun")
pytestmark = [
    pytest.mark.skipif(mpirun is None, reason="there is no mpirun (openmpi-bin)"),
    pytest.mark.skipif("LD_PRELOAD" in os.environ, reason="MPI would be started with a sanitizer's library"),
]
job = pathlib.Path(__file__).parent / "support" / "mpi_job.py"


def run(ranks, *arguments):
    """What each rank has printed."""
    environment = {
        **os.environ,
        # Open MPI runs neither as root nor more ranks than cores unless it is told to; other MPIs pass these over.
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
    }
    environment["PYTHONPATH"] = f"{job.parents[1]}:{environment['PYTHONPATH']}"
    command = [mpirun, "-n", str(ranks), sys.executable, "-B", "-m", "mpi4py", str(job), *map(str, arguments)]
    ran = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=120)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


@pytest.mark.parametrize("ranks", [1, 3])
def test_the_ranks_of_a_job_make_the_surface_of_one_process_and_fail_together(client, server, ranks):
    frames = 3
    with client.session(particle_radius=particle_radius, id=str(uuid.uuid4())) as session:
        with session.watch() as watcher:
            told = run(ranks, server.address, session.id, frames)
            seen = {}
            for frame in watcher:
                seen[frame.index] = frame
                if frame.time == 0.5 * (frames - 1):
                    break
    assert [its["session"] for its in told] == ranks * [session.id]
    for rank, its in enumerate(told):
        trades, no_names, first, not_finite, not_three, no_index, *others = its["results"]
        assert no_names == ["InvalidInput", f"rank {ranks - 1}: attributes is 5, must be 'all', a name, or names"]
        assert trades is True and first is True and others == [True, True] and its["dropped"] == 0
        assert not_finite == told[0]["results"][3] and not_three == told[0]["results"][4]
        for (kind, text), words in (not_finite, "nan"), (not_three, "(1, 2)"), (no_index, "nan" if rank else "index"):
            assert kind == "InvalidInput" and words in text, text
    for index, frame in seen.items():
        step = round(frame.time / 0.5)
        x, marks = particles_of(step), marks_of(step)
        whole = meniscus.reconstruct(x, particle_radius, attributes={"mark": marks})
        assert frame.mesh.sha256() == whole.sha256(), index
        assert sorted(frame.mesh.attributes["mark"]) == sorted(whole.attributes["mark"])
        assert frame.statistics.particles == len(x)


def test_files_take_the_place_of_a_server(tmp_path):
    mpi = pytest.importorskip("meniscus.mpi")
    folder = tmp_path / "surfaces"
    with mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, output=folder, policy="every-frame") as parts:
        assert parts.session_id == ""
        for index in range(3):
            assert parts.push(particles_of(index), time=0.5 * index)
    listed = re.findall(r'timestep="([^"]*)".*part="0" file="([^"]*)"', (folder / "surface.pvd").read_text())
    assert listed == [(time, f"surface-00000{i}-part-0.vtp") for i, time in enumerate(("0", "0.5", "1"))]
    for index, (_, name) in enumerate(listed):
        whole = meniscus.reconstruct(particles_of(index), particle_radius)
        written = (folder / name).read_text()
        assert f'NumberOfPoints="{len(whole.vertices)}"' in written
        assert f'NumberOfPolys="{len(whole.triangles)}"' in written
    with pytest.raises(meniscus.InvalidInput, match="surface.pvd is there"):
        mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, output=str(folder))
    for wrong in b"folder", 5:
        with pytest.raises(meniscus.InvalidInput, match="output is .*, must be a path"):
            mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, output=wrong)
    with pytest.raises(meniscus.InvalidInput, match="'server' and 'output' are both set"):
        mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, output=folder, server="unix:/nowhere")
    with pytest.raises(meniscus.InvalidInput, match="'server' is not set"):
        mpi.Parts(mpi.MPI.COMM_SELF, particle_radius)


@pytest.mark.usefixtures("server")  # a build without the service asks for the program that speaks to it first
def test_a_server_that_is_not_there_and_wrong_options_are_told_by_all_ranks():
    mpi = pytest.importorskip("meniscus.mpi")
    with pytest.raises(meniscus.ServerError, match="rank 0: .*unix:/nowhere"):
        mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, server="unix:/nowhere")
    for options, text in (
        ({"reconstruct_ranks": 2}, "reconstruct-ranks.* is 2, must be at most the 1 ranks"),
        ({"run": 1}, "the ranks agree on it"),
        ({"colour": 1}, "colour"),
    ):
        with pytest.raises(meniscus.InvalidInput, match=text):
            mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, server="unix:/nowhere", **options)


def test_a_call_within_another_and_a_frame_after_the_end_are_refused(server):
    mpi = pytest.importorskip("meniscus.mpi")

    class Nested:
        def __array__(self, *_, **__):
            parts.finish()

    with mpi.Parts(mpi.MPI.COMM_SELF, particle_radius, server=server.address) as parts:
        with pytest.raises(meniscus.InvalidInput, match="another call, which must return"):
            parts.push(Nested())
        assert parts.push(particles_of(0))
        parts.finish()
        with pytest.raises(meniscus.InvalidInput, match="the frames are finished"):
            parts.push(particles_of(1))
