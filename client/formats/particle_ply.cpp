#include <array>

#include "formats/particles.hpp"
#include "formats/ply.hpp"

namespace meniscus::formats {

Particles read_particle_ply(const std::string& name, std::string_view bytes) {
    PlyReader ply(name, bytes);
    Particles particles;
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
        particles.positions.reserve(3 * element.count);
        if (level) particles.levels.reserve(element.count);
        ply.read_rows(element, [&](std::size_t index, const PlyRow& row) {
            for (const auto& axis : axes)
                particles.positions.push_back(to_coordinate(row.scalars[*axis], index, ply.in()));
            if (level) particles.levels.push_back(to_level(row.scalars[*level], index, ply.in()));
        });
    }
    if (!found) ply.in().fail("a PLY file without vertices");
    ply.expect_end();
    return particles;
}

}  // namespace meniscus::formats
