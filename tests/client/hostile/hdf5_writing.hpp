// HDF5 files of tests, by HDF5's library.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace meniscus::test {

class Hdf5Writing {
public:
    explicit Hdf5Writing(const std::filesystem::path& path)
        : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
        if (file_ < 0) throw std::runtime_error(path.string() + " cannot be made");
    }
    ~Hdf5Writing() { H5Fclose(file_); }
    Hdf5Writing(const Hdf5Writing&) = delete;
    Hdf5Writing& operator=(const Hdf5Writing&) = delete;

    hid_t file() const { return file_; }
    void group(const std::string& name) const { H5Gclose(H5Gcreate2(file_, name.c_str(), 0, 0, 0)); }
    /// A dataset of doubles, stored as `type`. made: its creation property list, which is closed; 0: contiguous.
    void set(const std::string& name, const std::vector<double>& values, const std::vector<hsize_t>& shape,
             hid_t type = H5T_IEEE_F64LE, hid_t made = 0) const {
        const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
        const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, 0, made, 0);
        if (set < 0) throw std::runtime_error(name + " cannot be made");
        if (!values.empty()) H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        H5Dclose(set);
        H5Sclose(space);
        if (made != 0) H5Pclose(made);
    }

private:
    hid_t file_;
};

}  // namespace meniscus::test
