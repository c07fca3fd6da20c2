"""A recipe for Spack 1.0 or newer: core, C interface and Python package of Meniscus, without the service.

From a source folder, with this file as repos/mine/packages/meniscus/package.py of a repository of one's own
(`spack repo create`, `spack repo add`):

    spack dev-build meniscus@main +python

Of Draco there is no package: Spack's `draco` is another program.
"""

from spack.package import conflicts, depends_on, license, variant, version
from spack_repo.builtin.build_systems.cmake import CMakePackage


class Meniscus(CMakePackage):
    """Adaptive surfaces of SPH particles, by the method of Du and Kanai (WSCG 2014), with the same bits everywhere."""

    license("MIT")

    version("main", branch="main")

    variant("python", default=False, description="Python package")
    variant("hdf5", default=True, description="Read HDF5 files of particles")
    variant("tbb", default=True, description="Parallel loops by oneTBB in place of the standard library's threads")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.18:", type="build")
    depends_on("libpng")
    depends_on("nlohmann-json")
    depends_on("openssl")
    depends_on("pugixml")
    depends_on("xxhash")
    depends_on("zlib-api")
    depends_on("hdf5", when="+hdf5")
    depends_on("tbb", when="+tbb")
    depends_on("python@3.9:", when="+python", type=("build", "link", "run"))
    depends_on("py-numpy", when="+python", type=("build", "run"))
    depends_on("py-pybind11@2.6:", when="+python", type="build")

    conflicts("%gcc@:9", msg="Meniscus needs the C++20 of gcc 10 or newer")

    def cmake_args(self):
        spec = self.spec
        args = [
            self.define("MENISCUS_SERVICE", False),
            self.define("MENISCUS_CUDA", "OFF"),
            self.define("MENISCUS_TESTS", False),
            self.define("MENISCUS_STD_THREADS", spec.satisfies("~tbb")),
            self.define("MENISCUS_HDF5", "ON" if spec.satisfies("+hdf5") else "OFF"),
            self.define("MENISCUS_PYTHON", "ON" if spec.satisfies("+python") else "OFF"),
            self.define("CMAKE_DISABLE_FIND_PACKAGE_draco", True),
        ]
        if spec.satisfies("+python"):
            args.append(self.define("Python_EXECUTABLE", spec["python"].command.path))
        return args

    def setup_run_environment(self, env):
        if self.spec.satisfies("+python"):
            env.prepend_path("PYTHONPATH", self.prefix.lib.python3.join("dist-packages"))
