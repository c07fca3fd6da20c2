// HDF5: datasets in the root, the gas of Gadget and SWIFT ("PartType0"), a step of H5Part ("Step#0"), and what PySPH
// writes (a group of datasets for each kind of particles, below "particles"). Nothing is read that lies in another
// file. Otherwise a file is untrusted only as far as HDF5's library is: see client/README.md.
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/particles/particle_readers.hpp"

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

/// A file names filters by their numbers, and the library would look for what it does not know among the libraries of
/// HDF5_PLUGIN_PATH, and load them.
class NoPlugins {
public:
    NoPlugins() {
        H5PLget_loading_state(&loaded_);
        H5PLset_loading_state(0);
    }
    ~NoPlugins() { H5PLset_loading_state(loaded_); }
    NoPlugins(const NoPlugins&) = delete;
    NoPlugins& operator=(const NoPlugins&) = delete;

private:
    unsigned loaded_ = 0;
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

constexpr std::array hdf5_axes{"x", "y", "z"};

/// How a group has its particles' positions.
struct Hdf5Positions {
    std::string rows;  ///< the dataset of three coordinates each; empty: x, y and z are datasets of their own

    bool has(std::string_view name) const {
        return rows.empty() ? std::find(hdf5_axes.begin(), hdf5_axes.end(), name) != hdf5_axes.end() : name == rows;
    }
};

std::optional<Hdf5Positions> positions_in(hid_t group) {
    for (const char* rows : {"positions", "Coordinates"})
        if (has(group, rows)) return Hdf5Positions{rows};
    if (std::all_of(hdf5_axes.begin(), hdf5_axes.end(), [&](const char* axis) { return has(group, axis); }))
        return Hdf5Positions{};
    return std::nullopt;
}

/// Gadget's names of what others call otherwise.
std::string usual_hdf5_name(const std::string& name) {
    if (name == "Velocities") return "velocity";
    if (name == "ParticleIDs") return "id";
    return name;
}

/// A way to open objects that keeps to the file: it ends where a link leads to another one.
class Access {
public:
    /// kind: of property lists, H5P_GROUP_ACCESS or H5P_DATASET_ACCESS.
    explicit Access(hid_t kind) : list_(H5Pcreate(kind), H5Pclose) { H5Pset_elink_cb(list_, stop, &elsewhere_); }
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;

    hid_t list() const { return list_; }
    /// The file that a link named since the last call; none: none did.
    std::optional<std::string> elsewhere() { return std::exchange(elsewhere_, std::nullopt); }

private:
    static herr_t stop(const char*, const char*, const char* file, const char*, unsigned*, hid_t, void* elsewhere) {
        *static_cast<std::optional<std::string>*>(elsewhere) = file;
        return -1;
    }

    std::optional<std::string> elsewhere_;
    Handle list_;
};

struct Dataset {
    std::optional<ScalarType> type;  ///< none: no numbers, or none that are read
    std::size_t rows = 0;
    std::size_t columns = 1;
};

std::optional<ScalarType> scalar_type(hid_t type) {
    using T = ScalarType;
    const std::size_t size = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT)
        return size == 8 ? T::float64 : size == 4 ? std::optional(T::float32) : std::nullopt;
    if (H5Tget_class(type) != H5T_INTEGER) return std::nullopt;
    const bool is_signed = H5Tget_sign(type) != H5T_SGN_NONE;
    switch (size) {
        case 1:
            return is_signed ? T::int8 : T::uint8;
        case 2:
            return is_signed ? T::int16 : T::uint16;
        case 4:
            return is_signed ? T::int32 : T::uint32;
        case 8:
            return is_signed ? T::int64 : T::uint64;
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
        const Handle group = open_group(place_of_particles());
        const Hdf5Positions positions = *positions_in(group);
        Particles particles;
        positions.rows.empty() ? read_axes(group, particles) : read_rows(group, positions.rows, particles);
        ArrayCollector collector(at_);
        for (const std::string& name : names_in(group))
            if (!positions.has(name)) read_array(group, name, positions, particles, collector);
        collector.finish(particles.arrays, particles.left_out);
        return particles;
    }

private:
    [[noreturn]] void refuse_other_file(const std::string& what, const std::string& file) const {
        at_.fail(what + " in another file, " + quoted(file) +
                 "; only what a file holds itself is read: h5repack or h5copy brings it into one");
    }

    Handle open_group(const std::string& path) {
        Handle group(H5Gopen2(file_, path.c_str(), groups_.list()), H5Gclose);
        if (const auto file = groups_.elsewhere()) refuse_other_file("group " + quoted(path) + " lies", *file);
        return group;
    }

    /// The group of the particles: the one place of the file that has positions.
    std::string place_of_particles() {
        const std::vector<std::string> root = names_in(file_);
        std::vector<std::string> places;
        if (positions_in(file_)) places.emplace_back("/");
        for (const std::string& name : root)
            if (name == "PartType0" || name.starts_with("Step#")) add_place(name, places);
        if (has(file_, "particles")) {
            const Handle kinds = open_group("particles");
            for (const std::string& kind : kinds.there() ? names_in(kinds) : std::vector<std::string>{})
                add_place("particles/" + kind + "/arrays", places);
        }
        if (places.empty()) refuse_without_positions(root);
        if (places.size() > 1) {
            const std::string first = places.front();
            // PySPH's solids are others than its fluid.
            const auto fluid = std::find(places.begin(), places.end(), "particles/fluid/arrays");
            if (fluid == places.end())
                at_.fail("has particles in " + std::to_string(places.size()) + " places, " + first + " and " +
                         places.back() +
                         " among them; one frame is read: copy it to a file of its own (h5copy -i IN -o OUT -s " +
                         first + " -d " + first + ")");
            return *fluid;
        }
        return places.front();
    }
    void add_place(const std::string& path, std::vector<std::string>& places) {
        const Handle group = open_group(path);
        if (group.there() && positions_in(group)) places.push_back(path);
    }
    [[noreturn]] void refuse_without_positions(const std::vector<std::string>& root) const {
        constexpr std::size_t most_listed = 8;
        std::string there;
        for (std::size_t i = 0; i < std::min(root.size(), most_listed); ++i)
            there += (i == 0 ? "; its root has " : ", ") + quoted(root[i]);
        if (root.size() > most_listed) there += " and " + std::to_string(root.size() - most_listed) + " more";
        at_.fail(
            "no particles: neither positions (N, 3), nor Coordinates (N, 3), nor x, y and z, in the root, PartType0 "
            "(Gadget, SWIFT), Step#0 (H5Part) or particles/NAME/arrays (PySPH)" +
            there);
    }

    /// Before a value is read, or another file looked for.
    void refuse_values_of_other_files(hid_t set, const std::string& name) {
        const Handle made(H5Dget_create_plist(set), H5Pclose);
        if (!made.there()) at_.fail("dataset " + quoted(name) + " does not say where it has its values: it is damaged");
        std::array<char, 256> file{};
        if (H5Pget_external_count(made) > 0) {
            H5Pget_external(made, 0, file.size() - 1, file.data(), nullptr, nullptr);
            refuse_other_file("dataset " + quoted(name) + " has its values", file.data());
        }
        if (H5Pget_layout(made) == H5D_VIRTUAL) {
            H5Pget_virtual_filename(made, 0, file.data(), file.size() - 1);
            refuse_other_file("dataset " + quoted(name) + " is virtual, with values", file.data());
        }
    }

    /// The library takes the memory of a whole chunk, however little of it is there.
    void pay_chunk(hid_t set, const std::string& name) {
        const Handle made(H5Dget_create_plist(set), H5Pclose);
        if (H5Pget_layout(made) != H5D_CHUNKED) return;
        std::array<hsize_t, H5S_MAX_RANK> chunk{};
        const int dimensions = H5Pget_chunk(made, static_cast<int>(chunk.size()), chunk.data());
        const Handle type(H5Dget_type(set), H5Tclose);
        std::uint64_t bytes = H5Tget_size(type);
        for (int i = 0; i < dimensions; ++i) bytes *= chunk[static_cast<std::size_t>(i)];  // the library: below 2^32
        budget_.take(bytes, at_, "a chunk of dataset " + quoted(name));
    }

    /// shape: what it turned out to be.
    Handle open(hid_t group, const std::string& name, Dataset& shape) {
        Handle set(H5Dopen2(group, name.c_str(), sets_.list()), H5Dclose);
        if (const auto file = sets_.elsewhere()) refuse_other_file("dataset " + quoted(name) + " lies", *file);
        if (!set.there()) return set;
        refuse_values_of_other_files(set, name);
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
        pay_chunk(set, name);
        budget_.take(sizeof(double) * count, at_, "dataset " + quoted(name));
        std::vector<double> values(count);
        if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
            at_.fail("dataset " + quoted(name) + " is damaged, or compressed by what this build of HDF5 does not know");
        return values;
    }

    void read_rows(hid_t group, const std::string& name, Particles& particles) {
        Dataset shape;
        const Handle set = open(group, name, shape);
        if (!set.there() || !shape.type || shape.columns != 3)
            at_.fail("dataset " + quoted(name) + " is no list of three coordinates each, of shape (N, 3)");
        const std::vector<double> values = numbers(set, shape, name);
        budget_.take(2 * sizeof(float) * values.size(), at_, "the positions");
        particles.positions.reserve(values.size());
        for (const double value : values) set_coordinate(particles, particles.positions.size(), value, at_);
    }

    void read_axes(hid_t group, Particles& particles) {
        for (std::size_t axis = 0; axis < hdf5_axes.size(); ++axis) {
            const std::string name = hdf5_axes[axis];
            Dataset shape;
            const Handle set = open(group, name, shape);
            if (!set.there() || !shape.type || shape.columns != 1)
                at_.fail("dataset " + quoted(name) + " is no list of numbers");
            const std::vector<double> values = numbers(set, shape, name);
            if (axis == 0) {
                budget_.take(6 * sizeof(float) * values.size(), at_, "the positions");
                particles.positions.resize(3 * values.size());
            }
            if (values.size() != particles.count())
                at_.fail("dataset " + quoted(name) + " has " + std::to_string(values.size()) + " numbers, x has " +
                         std::to_string(particles.count()));
            for (std::size_t i = 0; i < values.size(); ++i) set_coordinate(particles, 3 * i + axis, values[i], at_);
        }
    }

    void read_array(hid_t group, const std::string& name, const Hdf5Positions& positions, const Particles& particles,
                    ArrayCollector& collector) {
        Dataset shape;
        const Handle set = open(group, name, shape);
        if (!set.there()) return collector.leave_out(name, "no dataset");
        if (!shape.type) return collector.leave_out(name, "no numbers");
        const std::size_t count = particles.count();
        // PySPH keeps rows of several numbers as one list.
        if (positions.rows.empty() && shape.columns == 1 && count != 0 && shape.rows % count == 0) {
            shape.columns = shape.rows / count;
            shape.rows = count;
        }
        if (shape.rows != count)
            return collector.leave_out(
                name, std::to_string(shape.rows) + " rows for " + std::to_string(count) + " particles");
        const std::string known = usual_hdf5_name(name);
        ArrayBuilder array(known, *shape.type, shape.columns, 0);
        if (array.wanted()) {
            budget_.take(sizeof(float) * count * shape.columns, at_, "dataset " + quoted(name));
            array = ArrayBuilder(known, *shape.type, shape.columns, count);
            for (const double value : numbers(set, shape, name)) array.add(value);
        }
        collector.add(std::move(array));
    }

    ByteCursor at_;
    ReadBudget budget_;
    Quiet quiet_;
    NoPlugins no_plugins_;
    Handle file_;
    Access groups_{H5P_GROUP_ACCESS};
    Access sets_{H5P_DATASET_ACCESS};
};

}  // namespace

Particles read_hdf5(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    // Debian's HDF5 is not made for threads.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    return Hdf5Reader(name, bytes, limits).read();
}

}  // namespace meniscus::formats
