"""The classes of errors, and what makes each."""

import pickle

import meniscus
import numpy as np
import pytest
from support.particles import crowd, particle_radius


def test_errors_have_one_base_and_that_of_python():
    for kind, base in [
        (meniscus.InvalidInput, ValueError),
        (meniscus.LimitExceeded, Exception),
        (meniscus.DeviceError, RuntimeError),
        (meniscus.ServerError, RuntimeError),
        (meniscus.ForkedError, RuntimeError),
    ]:
        assert issubclass(kind, meniscus.Error) and issubclass(kind, base)
    assert not issubclass(meniscus.LimitExceeded, ValueError)
    assert issubclass(meniscus.SurfaceWarning, UserWarning)


def test_errors_of_the_extension_are_those_of_the_package(client):
    with pytest.raises(meniscus.ServerError) as raised:
        client.session_info("00000000-0000-4000-8000-000000000000")
    assert type(raised.value) is meniscus.ServerError
    assert (raised.value.code, raised.value.status) == ("not_found", "NOT_FOUND")
    with pytest.raises(ValueError) as invalid:
        meniscus.Reconstructor(-1.0)
    assert type(invalid.value) is meniscus.InvalidInput


@pytest.mark.parametrize(
    "error",
    [
        meniscus.InvalidInput("wrong"),
        meniscus.LimitExceeded("much"),
        meniscus.DeviceError("broken", 1),
        meniscus.ServerError("gone", "unavailable", "UNAVAILABLE"),
        meniscus.ForkedError("forked"),
    ],
)
def test_errors_go_from_process_to_process(error):
    copied = pickle.loads(pickle.dumps(error))
    assert type(copied) is type(error) and str(copied) == str(error) and vars(copied) == vars(error)


def test_a_frame_beyond_the_memory_limit_is_refused_and_the_next_one_taken(positions, mesh):
    reconstructor = meniscus.Reconstructor(particle_radius, memory_limit=16 << 20, threads=1)
    with pytest.raises(meniscus.LimitExceeded, match="memory|bytes|MB|MiB"):
        reconstructor.reconstruct(crowd(300000))
    assert reconstructor.reconstruct(positions).sha256() == mesh.sha256()


def test_numpys_memory_error_stays_one():
    with pytest.raises(MemoryError):
        meniscus.reconstruct(np.broadcast_to(np.zeros(3, np.float32), (1 << 42, 3)), particle_radius)


def test_without_a_gpu_its_backend_is_refused(positions):
    if meniscus.Reconstructor(particle_radius).backend == "cuda":
        pytest.skip("there is a GPU")
    with pytest.raises(meniscus.InvalidInput, match="CUDA"):
        meniscus.Reconstructor(particle_radius, backend="cuda")
    with pytest.raises(meniscus.InvalidInput):
        meniscus.Reconstructor(particle_radius).reconstruct_on_device(positions)
