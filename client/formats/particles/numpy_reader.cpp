#include <algorithm>
#include <array>
#include <utility>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/containers/npy.hpp"
#include "formats/containers/npz.hpp"
#include "formats/containers/point_numbers.hpp"
#include "formats/containers/pysph_npz.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {
namespace {

void fill_positions(Particles& particles, const NpyArray& array, const ByteCursor& at) {
    if (!array.unread.empty()) at.fail("holds " + array.unread + "; positions are numbers");
    if (array.shape.size() != 2 || array.shape[1] != 3)
        at.fail("has the shape " + shape_text(array.shape) + "; positions have (N, 3)");
    const std::size_t count = array.shape[0];
    particles.positions.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            set_coordinate(particles, particles.positions.size(), array.at(i, axis), at);
}

/// Before they are read: as float32, with the remainders of what that does not hold.
void pay_coordinates(const NpyArray& array, ReadBudget& budget, const ByteCursor& at) {
    const std::size_t each = array.type == ScalarType::float32 ? sizeof(float) : 2 * sizeof(float);
    budget.take(each * (array.data.size() / size_of(array.type)), at, "what it holds");
}

/// One coordinate of each particle.
void fill_axis(Particles& particles, std::size_t axis, const NpyArray& array, const ByteCursor& at) {
    if (!array.unread.empty()) at.fail("holds " + array.unread + "; coordinates are numbers");
    if (array.shape.size() != 1) at.fail("has the shape " + shape_text(array.shape) + "; coordinates have (N,)");
    const std::size_t count = array.shape[0];
    if (axis == 0) particles.positions.resize(3 * count);
    if (count != particles.count())
        at.fail("has " + std::to_string(count) + " coordinates, x has " + std::to_string(particles.count()));
    for (std::size_t i = 0; i < count; ++i) set_coordinate(particles, 3 * i + axis, array.at(i, 0), at);
}

void fill_levels(Particles& particles, const NpyArray& array, const ByteCursor& at) {
    if (!array.has_rows(particles.count()) || array.columns() != 1 || !is_integer(array.type)) return;
    particles.levels.reserve(particles.count());
    for (std::size_t i = 0; i < particles.count(); ++i) particles.levels.push_back(to_level(array.at(i, 0), i, at));
}

/// PySPH keeps rows of several numbers as one list.
void divide_into_rows(NpyArray& array, std::size_t count) {
    if (array.shape.size() == 1 && count != 0 && array.shape[0] % count == 0)
        array.shape = {count, array.shape[0] / count};
}

/// The arrays of PySPH's particles, which are pickled together.
void read_pysph(NpzReader& file, Particles& particles) {
    file.with("particles", [&](const NpyArray& pickled, const ByteCursor& place) {
        std::vector<NamedNpyArray> arrays = pysph_arrays(place, pickled.data, file.budget());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string_view name = std::string_view("xyz").substr(axis, 1);
            const auto found =
                std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.name == name; });
            if (found == arrays.end()) place.fail("has no array " + quoted(name));
            if (!found->array.unread.empty()) place.fail("array " + quoted(name) + ": " + found->array.unread);
            pay_coordinates(found->array, file.budget(), place);
            fill_axis(particles, axis, found->array, place);
        }
        ArrayCollector collector(place);
        for (auto& [name, array] : arrays) {
            if (name == "x" || name == "y" || name == "z") continue;
            divide_into_rows(array, particles.count());
            collect_rows(collector, name, array, particles.count(), file.budget(), place);
        }
        collector.finish(particles.arrays, particles.left_out);
    });
}

bool has_pickled_particles(NpzReader& file) {
    bool found = false;
    if (file.has("particles"))
        file.with("particles",
                  [&](const NpyArray& array, const ByteCursor&) { found = array.unread == "pickled Python objects"; });
    return found;
}

[[noreturn]] void refuse_without_positions(NpzReader& file) {
    for (const std::string& name : file.names())
        file.with(name, [&](const NpyArray& array, const ByteCursor& place) {
            if (!array.unread.empty())
                place.fail(
                    "holds " + array.unread +
                    ", which are not read: save plain arrays, as numpy.savez(FILE, positions=..., velocity=...)");
        });
    file.at().fail("neither an array positions nor arrays x, y and z");
}

}  // namespace

Particles read_npy(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    const ByteCursor at(name, bytes);
    ReadBudget budget(limits, bytes.size(), at);
    const NpyArray array = read_npy_array(at, bytes);
    pay_coordinates(array, budget, at);
    Particles particles;
    fill_positions(particles, array, at);
    return particles;
}

Particles read_npz(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    static constexpr std::array axes{"x", "y", "z"};
    NpzReader file(name, bytes, limits);
    Particles particles;
    if (file.has("positions")) {
        file.with("positions", [&](const NpyArray& array, const ByteCursor& place) {
            pay_coordinates(array, file.budget(), place);
            fill_positions(particles, array, place);
        });
    } else if (file.has("x") && file.has("y") && file.has("z")) {
        for (std::size_t axis = 0; axis < axes.size(); ++axis)
            file.with(axes[axis], [&](const NpyArray& array, const ByteCursor& place) {
                pay_coordinates(array, file.budget(), place);
                fill_axis(particles, axis, array, place);
            });
    } else if (has_pickled_particles(file)) {
        read_pysph(file, particles);
        return particles;
    } else {
        refuse_without_positions(file);
    }
    for (const char* levels : {"levels", "level"})
        if (file.has(levels) && particles.levels.empty())
            file.with(levels,
                      [&](const NpyArray& array, const ByteCursor& place) { fill_levels(particles, array, place); });
    if (file.has("triangles"))
        file.with("triangles", [&](const NpyArray& array, const ByteCursor&) {
            if (array.shape.size() == 2) particles.faces = array.shape[0];
        });
    ArrayCollector collector(file.at());
    file.collect(collector, particles.count(), {"positions", "x", "y", "z", "level", "levels", "triangles"});
    collector.finish(particles.arrays, particles.left_out);
    return particles;
}

}  // namespace meniscus::formats
