"""Arrays of the GPU's libraries, there and back. Skipped where there is no GPU, or where a library is missing."""

import meniscus
import numpy as np
import pytest
from support.particles import crowd, particle_radius


@pytest.fixture(scope="module")
def reconstructor():
    try:
        return meniscus.Reconstructor(particle_radius, attributes=["age"], backend="cuda")
    except meniscus.Error as error:
        pytest.skip(str(error))


def of_cupy(array):
    return pytest.importorskip("cupy").asarray(array)


def of_torch(array):
    return pytest.importorskip("torch").as_tensor(array.copy(), device="cuda")


def of_numba(array):
    return pytest.importorskip("numba.cuda").to_device(array)


libraries = pytest.mark.parametrize("on_gpu", [of_cupy, of_torch, of_numba])


@pytest.fixture(scope="module")
def ages(positions):
    return np.linspace(0, 1, len(positions), dtype=np.float32)


@pytest.fixture(scope="module")
def expected(positions, ages):
    cpu = meniscus.Reconstructor(particle_radius, attributes=["age"], backend="cpu")
    return cpu.reconstruct(positions, attributes={"age": ages})


def on_host(array):
    return of_cupy(array).get()


def require_same(mesh, expected, fetch):
    for name in "lattice", "triangles", "normals":
        assert np.array_equal(fetch(getattr(mesh, name)), getattr(expected, name)), name


@libraries
def test_particles_on_the_gpu_give_the_cpus_mesh(reconstructor, positions, ages, expected, on_gpu):
    mesh = reconstructor.reconstruct(on_gpu(positions), attributes={"age": on_gpu(ages)})
    assert mesh.statistics.backend == "cuda"
    require_same(mesh, expected, np.asarray)
    assert np.array_equal(mesh.attributes["age"], expected.attributes["age"])


@libraries
def test_a_mesh_that_stays_on_the_gpu_is_the_cpus(reconstructor, positions, ages, expected, on_gpu):
    mesh = reconstructor.reconstruct_on_device(on_gpu(positions), attributes={"age": on_gpu(ages)})
    require_same(mesh, expected, on_host)
    assert np.array_equal(on_host(mesh.attribute("age")), expected.attributes["age"])
    assert (mesh.cell_size, mesh.offset_bits, mesh.device) == (expected.cell_size, expected.offset_bits, 0)


def test_particles_of_the_host_may_give_a_mesh_on_the_gpu(reconstructor, positions, ages, expected):
    require_same(reconstructor.reconstruct_on_device(positions, attributes={"age": ages}), expected, on_host)


def test_a_mesh_on_the_gpu_ends_with_the_next_frame_and_says_so(reconstructor, positions, ages):
    mesh = reconstructor.reconstruct_on_device(positions, attributes={"age": ages})
    reconstructor.reconstruct(positions, attributes={"age": ages})
    with pytest.raises(meniscus.Error, match="gone from the GPU"):
        mesh.triangles  # noqa: B018


def test_torchs_kernels_before_a_frame_are_waited_for(reconstructor):
    torch = pytest.importorskip("torch")
    particles = crowd(200_000)
    ages = np.zeros(len(particles), np.float32)
    expected = reconstructor.reconstruct(particles, attributes={"age": ages})
    for _ in range(5):
        slow = torch.as_tensor(particles, device="cuda")
        for _ in range(200):  # of which some are still to run when the frame is given
            slow = -(slow.repeat(8, 1)[: len(particles)])
        mesh = reconstructor.reconstruct(slow, attributes={"age": torch.zeros(len(particles), device="cuda")})
        require_same(mesh, expected, np.asarray)


@libraries
def test_what_is_no_number_on_the_gpu_is_refused(reconstructor, positions, ages, on_gpu):
    wrong = positions.copy()
    wrong[7, 1] = np.nan
    with pytest.raises(meniscus.InvalidInput, match="nan"):
        reconstructor.reconstruct(on_gpu(wrong), attributes={"age": on_gpu(ages)})
