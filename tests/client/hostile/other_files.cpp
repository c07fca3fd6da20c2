#include "hostile/other_files.hpp"

#ifdef MENISCUS_HDF5
#include <sys/stat.h>

#include <stdexcept>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/scalar.hpp"
#include "hostile/hdf5_writing.hpp"
#endif

namespace meniscus::test {

#ifdef MENISCUS_HDF5
namespace {

constexpr double secret = 6364136.0;
constexpr hsize_t count = 4;
const std::vector<double> line(count, secret);

/// x, y and z in Step#0, of which `made` says where the values are; written: there.
void external_storage(const std::filesystem::path& path, const std::string& other) {
    const Hdf5Writing out(path);
    out.group("Step#0");
    for (const char* axis : {"x", "y", "z"}) {
        const hid_t made = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_external(made, other.c_str(), 0, count * sizeof(double));
        out.set(std::string("Step#0/") + axis, {}, {count}, H5T_IEEE_F64LE, made);
    }
}

void virtual_sets(const std::filesystem::path& path, const std::string& other) {
    const Hdf5Writing out(path);
    out.group("Step#0");
    for (const char* axis : {"x", "y", "z"}) {
        const hid_t made = H5Pcreate(H5P_DATASET_CREATE);
        const hid_t space = H5Screate_simple(1, &count, nullptr);
        H5Pset_virtual(made, space, other.c_str(), (std::string("Step#0/") + axis).c_str(), space);
        H5Sclose(space);
        out.set(std::string("Step#0/") + axis, {}, {count}, H5T_IEEE_F64LE, made);
    }
}

}  // namespace
#endif

std::vector<OtherFile> write_files_with_others(const std::filesystem::path& folder) {
    std::vector<OtherFile> out;
#ifdef MENISCUS_HDF5
    const std::string raw = (folder / "raw").string(), other = (folder / "other.h5").string(),
                      pipe = (folder / "pipe").string();
    std::string bytes;
    for (const double x : line) formats::store(bytes, x);
    formats::write_file(raw, bytes);
    if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error(pipe + " cannot be made");
    {
        const Hdf5Writing file(other);
        file.group("Step#0");
        for (const char* axis : {"x", "y", "z"}) file.set(std::string("Step#0/") + axis, line, {count});
    }
    const auto path = [&](const std::string& name) { return folder / (name + ".h5"); };
    external_storage(path("storage"), raw);
    out.push_back({"external storage", path("storage"), raw});
    external_storage(path("fifo"), pipe);
    out.push_back({"external storage in a FIFO", path("fifo"), pipe});
    virtual_sets(path("virtual"), other);
    out.push_back({"virtual datasets", path("virtual"), other});
    {
        const Hdf5Writing file(path("group"));
        H5Lcreate_external(other.c_str(), "Step#0", file.file(), "Step#0", 0, 0);
    }
    out.push_back({"an external link to a group", path("group"), other});
    {
        const Hdf5Writing file(path("sets"));
        file.group("Step#0");
        for (const char* axis : {"x", "y", "z"}) {
            const std::string name = std::string("Step#0/") + axis;
            H5Lcreate_external(other.c_str(), name.c_str(), file.file(), name.c_str(), 0, 0);
        }
    }
    out.push_back({"external links to sets", path("sets"), other});
    {
        const Hdf5Writing file(path("soft"));
        H5Lcreate_external(other.c_str(), "/", file.file(), "elsewhere", 0, 0);
        H5Lcreate_soft("/elsewhere/Step#0", file.file(), "Step#0", 0, 0);
    }
    out.push_back({"a soft link through an external one", path("soft"), other});
    {
        const Hdf5Writing file(path("array"));
        file.group("Step#0");
        for (const char* axis : {"x", "y", "z"}) file.set(std::string("Step#0/") + axis, line, {count});
        H5Lcreate_external(other.c_str(), "Step#0/x", file.file(), "Step#0/pressure", 0, 0);
    }
    out.push_back({"an external link to an array beside the positions", path("array"), other});
#else
    (void)folder;
#endif
    return out;
}

}  // namespace meniscus::test
