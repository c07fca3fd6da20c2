// A surface as glTF 2.0 in one file: plain, or with Draco's bytes (KHR_draco_mesh_compression).
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/glb_vertices.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::files {

/// The bounds of positions, as the file holds them.
struct GlbBounds {
    std::array<double, 3> low{}, high{};
};

/// A mesh that Draco has coded.
struct GlbDracoMesh {
    struct Attribute {
        GlbVertices form;  ///< the attribute, its bytes left out
        std::uint32_t id = 0;
    };
    std::string_view bytes{};
    std::size_t points = 0;  ///< number of points that Draco decodes
    std::size_t triangles = 0;
    std::vector<Attribute> attributes{};  ///< the positions first
    GlbBounds bounds{};
};

/// The one node of the scene, in which the mesh is, or whose children are its parts.
struct GlbRoot {
    std::array<double, 3> translation{};
    std::optional<std::array<double, 4>> rotation{};  ///< a quaternion, x y z w
};

/// Parts are added, then comes the file. Without parts it holds no surface.
class GlbDocument {
public:
    explicit GlbDocument(const GlbRoot& root);

    /// The whole surface. vertices: the positions first.
    void add(const std::vector<GlbVertices>& vertices, std::span<const Triangle> triangles);
    void add(const GlbDracoMesh& mesh);
    /// A part with positions in uint16 (KHR_mesh_quantization), whose unit is `scale`.
    void add_part(const std::string& name, const GlbDracoMesh& mesh, const std::array<double, 3>& translation,
                  double scale);

    /// Throws LimitExceeded if the file would have 4 GiB or more.
    std::string file() &&;

private:
    using Json = nlohmann::ordered_json;

    /// Returns the view's index.
    std::size_t add_view(std::string_view part, const Json& properties);
    /// Returns the accessor's index.
    std::size_t add_accessor(Json accessor);
    Json draco_primitive(const GlbDracoMesh& mesh);
    /// Returns the mesh's index.
    std::size_t add_mesh(const std::string& name, const Json& primitive);
    void require_extension(const char* name);

    Json root_;
    Json extensions_ = Json::array();
    Json parts_ = Json::array();  ///< their nodes
    Json meshes_ = Json::array();
    Json accessors_ = Json::array();
    Json views_ = Json::array();
    std::string buffer_;
};

}  // namespace meniscus::files
