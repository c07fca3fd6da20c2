#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "formats/containers/array_collector.hpp"
#include "formats/containers/ply.hpp"
#include "formats/containers/point_numbers.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {

Particles read_particle_ply(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    PlyReader ply(name, bytes, limits);
    Particles particles;
    ArrayCollector collector(ply.in());
    bool found = false;
    for (const PlyElement& element : ply.elements()) {
        if (element.name == "face" || element.name == "tristrips") particles.faces += element.count;
        if (element.name != "vertex" || found) {
            ply.read_rows(element, [](std::size_t, const PlyRow&) {});
            continue;
        }
        found = true;
        const std::array axes{element.scalar("x"), element.scalar("y"), element.scalar("z")};
        for (const auto& axis : axes)
            if (!axis) ply.in().fail("its vertices have no scalar properties x, y and z");
        auto level = element.scalar("level");
        if (level && !is_integer(element.properties[*level].type)) level.reset();
        ply.expect_rows(element);
        // Coordinates with their remainders, and four bytes for any other number.
        ply.budget().take((3 + element.properties.size()) * sizeof(float) * element.count, ply.in(), "its vertices");
        std::vector<std::pair<std::size_t, ArrayBuilder>> arrays;  // by property
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (p == level || std::find(axes.begin(), axes.end(), p) != axes.end()) continue;
            if (property.list_count_type)
                collector.leave_out(property.name, "a list");
            else
                arrays.emplace_back(p, ArrayBuilder(property.name, property.type, 1, element.count));
        }
        particles.positions.reserve(3 * element.count);
        if (level) particles.levels.reserve(element.count);
        ply.read_rows(element, [&](std::size_t index, const PlyRow& row) {
            for (const auto& axis : axes)
                set_coordinate(particles, particles.positions.size(), row.scalars[*axis], ply.in());
            if (level) particles.levels.push_back(to_level(row.scalars[*level], index, ply.in()));
            for (auto& [p, array] : arrays) array.add(row.scalars[p]);
        });
        for (auto& [p, array] : arrays) collector.add(std::move(array));
    }
    if (!found) ply.in().fail("a PLY file without vertices");
    ply.expect_end();
    collector.finish(particles.arrays, particles.left_out);
    return particles;
}

}  // namespace meniscus::formats
