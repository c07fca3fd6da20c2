// The changes to a mesh before it is written, and while it is.
#pragma once

#include <optional>

#include "editing/origin.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "meniscus/settings.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

/// The flag --no-triangle-levels.
void add_triangle_levels_flag(CLI::App& command, bool& without_levels);

/// The flags --mesh-aabb, --quads, --no-triangle-levels and --compress, and what --origin asks of the mesh.
struct MeshEdits {
    std::optional<editing::Origin> origin;  ///< positions are relative to it until they are written
    std::optional<Box> box;                 ///< triangles without a corner in it are left out
    bool quads = false;                     ///< pairs of triangles are merged
    bool without_levels = false;            ///< the file has no levels of triangles
    bool compress = false;                  ///< the file is written smaller, by the way that its format has

    void add_to(CLI::App& command);
    /// Whether the mesh is another one afterwards.
    bool any() const { return origin || box || quads || without_levels; }
    /// Throws InvalidInput if files of this format cannot hold the result: to be called before long work.
    void require(formats::MeshFormat format) const;
};

}  // namespace meniscus::cli
