// HDF5: a step of H5Part (datasets x, y, z of one group, "Step#0") and what PySPH writes (a group of datasets for each
// kind of particles, below "particles"). A file is untrusted only as far as HDF5's library is: see client/README.md.
#include "formats/bytes/byte_cursor.hpp"
#include "formats/particles/particle_readers.hpp"

#ifdef MENISCUS_HDF5
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/read_budget.hpp"
#include "formats/containers/array_collector.hpp"

namespace meniscus::formats {
namespace {

/// One of HDF5's handles.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    Handle(hid_t id, Close close) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;

    bool there() const { return id_ >= 0; }
    operator hid_t() const { return id_; }

private:
    hid_t id_;
    Close close_;
};

/// The library prints its errors; this program says one line itself.
class Quiet {
public:
    Quiet() {
        H5Eget_auto2(H5E_DEFAULT, &report_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Quiet() { H5Eset_auto2(H5E_DEFAULT, report_, data_); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

private:
    H5E_auto2_t report_ = nullptr;
    void* data_ = nullptr;
};

/// From the bytes, which the library copies: a file may have been standard input.
Handle open_image(const ByteCursor& at, std::string_view bytes) {
    constexpr std::size_t growth = 4096;
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_core(access, growth, 0);
    if (H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()) < 0)
        at.fail("not an HDF5 file, or too large for memory");
    // The library refuses the bytes if there is a file of this name, so that there must be none, wherever this runs.
    Handle file(H5Fopen("/dev/null/no file", H5F_ACC_RDONLY, access), H5Fclose);
    if (!file.there()) at.fail("not an HDF5 file");
    return file;
}

/// Names of what a group has, in the order of the names.
std::vector<std::string> names_in(hid_t group) {
    std::vector<std::string> names;
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
        static_cast<std::vector<std::string>*>(into)->emplace_back(name);
        return 0;
    };
    H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
    return names;
}

bool has(hid_t group, const char* name) {
    return H5Lexists(group, name, H5P_DEFAULT) > 0;
}

bool has_axes(hid_t group) {
    return has(group, "x") && has(group, "y") && has(group, "z");
}

struct Dataset {
    std::optional<ScalarType> type;  ///< none: no numbers, or none that are read
    std::size_t rows = 0;
    std::size_t columns = 1;
};

std::optional<ScalarType> scalar_type(hid_t type) {
    using enum ScalarType;
    const std::size_t size = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT) return size == 8 ? float64 : size == 4 ? std::optional(float32) : std::nullopt;
    if (H5Tget_class(type) != H5T_INTEGER) return std::nullopt;
    const bool is_signed = H5Tget_sign(type) != H5T_SGN_NONE;
    switch (size) {
        case 1:
            return is_signed ? int8 : uint8;
        case 2:
            return is_signed ? int16 : uint16;
        case 4:
            return is_signed ? int32 : uint32;
        case 8:
            return is_signed ? int64 : uint64;
        default:
            return std::nullopt;
    }
}

/// The particles of one group after the other.
class Hdf5Reader {
public:
    Hdf5Reader(const std::string& name, std::string_view bytes, const ReadLimits& limits)
        : at_(name, bytes), budget_(limits, 3 * bytes.size(), at_), file_(open_image(at_, bytes)) {}

    Particles read() {
        const Handle group = group_of_particles();
        Particles particles;
        read_positions(group, particles);
        ArrayCollector collector;
        for (const std::string& name : names_in(group)) {
            if (name == "x" || name == "y" || name == "z") continue;
            read_array(group, name, particles, collector);
        }
        collector.finish(particles.arrays, particles.left_out);
        return particles;
    }

private:
    /// Where x, y and z are: the one place of the file that has them.
    Handle group_of_particles() {
        std::vector<std::string> places;
        if (has_axes(file_)) places.emplace_back("/");
        for (const std::string& name : names_in(file_))
            if (name.starts_with("Step#")) add_place(name, places);
        if (has(file_, "particles")) {
            const Handle kinds(H5Gopen2(file_, "particles", H5P_DEFAULT), H5Gclose);
            for (const std::string& kind : kinds.there() ? names_in(kinds) : std::vector<std::string>{})
                add_place("particles/" + kind + "/arrays", places);
        }
        if (places.empty())
            at_.fail(
                "no particles: neither x, y and z in a group Step#0 (H5Part), nor in particles/NAME/arrays (PySPH)");
        if (places.size() > 1) {
            const std::string first = places.front();
            // PySPH's solids are others than its fluid.
            const auto fluid = std::find(places.begin(), places.end(), "particles/fluid/arrays");
            if (fluid == places.end())
                at_.fail("has particles in " + std::to_string(places.size()) + " places, " + first + " and " +
                         places.back() +
                         " among them; one frame is read: copy it to a file of its own (h5copy -i IN -o OUT -s " +
                         first + " -d " + first + ")");
            places = {*fluid};
        }
        return Handle(H5Gopen2(file_, places.front().c_str(), H5P_DEFAULT), H5Gclose);
    }
    void add_place(const std::string& path, std::vector<std::string>& places) const {
        const Handle group(H5Gopen2(file_, path.c_str(), H5P_DEFAULT), H5Gclose);
        if (group.there() && has_axes(group)) places.push_back(path);
    }

    /// shape: what it turned out to be.
    Handle open(hid_t group, const std::string& name, Dataset& shape) const {
        Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
        if (!set.there()) return set;
        const Handle type(H5Dget_type(set), H5Tclose);
        const Handle space(H5Dget_space(set), H5Sclose);
        std::array<hsize_t, 2> extent{0, 1};
        const int dimensions = H5Sget_simple_extent_ndims(space);
        if (dimensions == 1 || dimensions == 2) {
            H5Sget_simple_extent_dims(space, extent.data(), nullptr);
            shape.type = scalar_type(type);
        }
        shape.rows = extent[0];
        shape.columns = dimensions == 2 ? extent[1] : 1;
        return set;
    }

    /// All numbers, as float64: exact for what is kept of them, but for integers beyond 2^53.
    std::vector<double> numbers(hid_t set, const Dataset& shape, const std::string& name) {
        if (shape.columns != 0 && shape.rows > budget_.left() / sizeof(double) / shape.columns)
            at_.fail("dataset " + quoted(name) + " has " + std::to_string(shape.rows) + " x " +
                     std::to_string(shape.columns) + " numbers, more than the file may take in memory");
        const std::size_t count = shape.rows * shape.columns;
        budget_.take(sizeof(double) * count, at_, "dataset " + quoted(name));
        std::vector<double> values(count);
        if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
            at_.fail("dataset " + quoted(name) + " is damaged, or compressed by what this build of HDF5 does not know");
        budget_.give_back(sizeof(double) * count);
        return values;
    }

    void read_positions(hid_t group, Particles& particles) {
        static constexpr std::array<const char*, 3> axes{"x", "y", "z"};
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            const std::string name = axes[axis];
            Dataset shape;
            const Handle set = open(group, name, shape);
            if (!set.there() || !shape.type || shape.columns != 1)
                at_.fail("dataset " + quoted(name) + " is no list of numbers");
            const std::vector<double> values = numbers(set, shape, name);
            if (axis == 0) {
                budget_.take(3 * sizeof(float) * values.size(), at_, "the positions");
                particles.positions.resize(3 * values.size());
            }
            if (values.size() != particles.count())
                at_.fail("dataset " + quoted(name) + " has " + std::to_string(values.size()) + " numbers, x has " +
                         std::to_string(particles.count()));
            for (std::size_t i = 0; i < values.size(); ++i) set_coordinate(particles, 3 * i + axis, values[i], at_);
        }
    }

    void read_array(hid_t group, const std::string& name, Particles& particles, ArrayCollector& collector) {
        Dataset shape;
        const Handle set = open(group, name, shape);
        if (!set.there()) return collector.leave_out(name, "no dataset");
        if (!shape.type) return collector.leave_out(name, "no numbers");
        const std::size_t count = particles.count();
        // PySPH keeps rows of several numbers as one list.
        if (shape.columns == 1 && count != 0 && shape.rows % count == 0) {
            shape.columns = shape.rows / count;
            shape.rows = count;
        }
        if (shape.rows != count)
            return collector.leave_out(
                name, std::to_string(shape.rows) + " rows for " + std::to_string(count) + " particles");
        ArrayBuilder array(name, *shape.type, shape.columns, 0);
        if (array.wanted()) {
            budget_.take(sizeof(float) * count * shape.columns, at_, "dataset " + quoted(name));
            array = ArrayBuilder(name, *shape.type, shape.columns, count);
            for (const double value : numbers(set, shape, name)) array.add(value);
        }
        collector.add(std::move(array));
    }

    ByteCursor at_;
    ReadBudget budget_;
    Quiet quiet_;
    Handle file_;
};

}  // namespace

Particles read_hdf5(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    // Debian's HDF5 is not made for threads.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    return Hdf5Reader(name, bytes, limits).read();
}

}  // namespace meniscus::formats

#else

namespace meniscus::formats {

Particles read_hdf5(const std::string& name, std::string_view bytes, const ReadLimits&) {
    ByteCursor(name, bytes).fail("this build reads no HDF5: build it where libhdf5-dev is installed");
}

}  // namespace meniscus::formats

#endif
