#include "files/glb_document.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "files/glb_container.hpp"

namespace meniscus::files {
namespace {

using Json = nlohmann::ordered_json;

constexpr int triangle_list = 4;
enum Target { array_buffer = 34962, element_array_buffer = 34963 };

std::string type_name(std::size_t components) {
    return components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
}

/// Every vertex at a multiple of four bytes, as glTF wants it.
std::string padded(const GlbVertices& vertices, std::size_t stride) {
    const std::size_t size = vertices.vertex_bytes();
    std::string out;
    out.reserve(vertices.bytes.size() / size * stride);
    for (std::size_t i = 0; i < vertices.bytes.size(); i += size) {
        out.append(vertices.bytes, i, size);
        out.append(stride - size, '\0');
    }
    return out;
}

Json accessor(const GlbVertices& form, std::size_t count) {
    Json out{{"componentType", static_cast<int>(form.type)}, {"count", count}, {"type", type_name(form.components)}};
    if (form.normalized) out["normalized"] = true;
    return out;
}

Json index_accessor(std::size_t triangles) {
    return Json{
        {"componentType", static_cast<int>(GlbComponent::unsigned_int)}, {"count", 3 * triangles}, {"type", "SCALAR"}};
}

void set_bounds(Json& accessor, const GlbBounds& bounds) {
    accessor["min"] = bounds.low;
    accessor["max"] = bounds.high;
}

/// The bounds of at least one position in float32.
GlbBounds bounds_of(const GlbVertices& positions) {
    GlbBounds bounds;
    for (std::size_t i = 0; i < positions.bytes.size() / sizeof(float); ++i) {
        float value = 0.0F;
        std::memcpy(&value, positions.bytes.data() + i * sizeof value, sizeof value);
        double& low = bounds.low[i % 3];
        double& high = bounds.high[i % 3];
        low = i < 3 ? value : std::min<double>(low, value);
        high = i < 3 ? value : std::max<double>(high, value);
    }
    return bounds;
}

Json primitive_of(Json attributes, std::size_t indices) {
    return Json{{"attributes", std::move(attributes)}, {"indices", indices}, {"material", 0}, {"mode", triangle_list}};
}

}  // namespace

GlbDocument::GlbDocument(const GlbRoot& root) : root_{{"name", "surface"}, {"translation", root.translation}} {
    if (root.rotation) root_["rotation"] = *root.rotation;
}

void GlbDocument::add(const std::vector<GlbVertices>& vertices, std::span<const Triangle> triangles) {
    const std::size_t count = vertices.front().bytes.size() / vertices.front().vertex_bytes();
    Json attributes;
    for (const GlbVertices& each : vertices) {
        const std::size_t stride = glb_aligned(each.vertex_bytes());
        Json one = accessor(each, count);
        const Json properties{{"byteStride", stride}, {"target", static_cast<int>(array_buffer)}};
        one["bufferView"] = stride == each.vertex_bytes() ? add_view(each.bytes, properties)
                                                          : add_view(padded(each, stride), properties);
        if (&each == &vertices.front()) set_bounds(one, bounds_of(each));
        attributes[each.name] = add_accessor(std::move(one));
    }
    Json corners = index_accessor(triangles.size());
    corners["bufferView"] = add_view({reinterpret_cast<const char*>(triangles.data()), triangles.size_bytes()},
                                     Json{{"target", static_cast<int>(element_array_buffer)}});
    root_["mesh"] = add_mesh("surface", primitive_of(std::move(attributes), add_accessor(std::move(corners))));
}

void GlbDocument::add(const GlbDracoMesh& mesh) {
    root_["mesh"] = add_mesh("surface", draco_primitive(mesh));
}

void GlbDocument::add_part(const std::string& name, const GlbDracoMesh& mesh, const std::array<double, 3>& translation,
                           double scale) {
    const std::size_t index = add_mesh(name, draco_primitive(mesh));
    require_extension("KHR_mesh_quantization");
    parts_.push_back(
        Json{{"mesh", index}, {"translation", translation}, {"scale", std::array<double, 3>{scale, scale, scale}}});
}

std::string GlbDocument::file() && {
    Json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "Meniscus"}};
    document["scene"] = 0;
    // The format has no empty lists: a file without a surface has none at all.
    if (meshes_.empty()) {
        document["scenes"] = Json::array({Json{{"name", "no surface"}}});
        return glb_container(document.dump(), {});
    }
    if (!extensions_.empty())
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) document[list] = extensions_;
    document["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
    Json nodes = Json::array();
    for (std::size_t i = 1; i <= parts_.size(); ++i) root_["children"].push_back(i);
    nodes.push_back(std::move(root_));
    for (Json& part : parts_) nodes.push_back(std::move(part));
    document["nodes"] = std::move(nodes);
    document["meshes"] = std::move(meshes_);
    const Json look{{"baseColorFactor", {0.1, 0.38, 0.5, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.1}};
    document["materials"] = Json::array({Json{{"name", "water"}, {"pbrMetallicRoughness", look}}});
    document["accessors"] = std::move(accessors_);
    document["bufferViews"] = std::move(views_);
    document["buffers"] = Json::array({Json{{"byteLength", buffer_.size()}}});
    return glb_container(document.dump(), buffer_);
}

std::size_t GlbDocument::add_view(std::string_view part, const Json& properties) {
    buffer_.resize(glb_aligned(buffer_.size()));
    Json view{{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", part.size()}};
    view.update(properties);
    views_.push_back(std::move(view));
    buffer_ += part;
    return views_.size() - 1;
}

std::size_t GlbDocument::add_accessor(Json accessor) {
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
}

nlohmann::ordered_json GlbDocument::draco_primitive(const GlbDracoMesh& mesh) {
    require_extension("KHR_draco_mesh_compression");
    Json attributes;
    Json ids;
    for (const GlbDracoMesh::Attribute& each : mesh.attributes) {
        Json one = accessor(each.form, mesh.points);
        if (&each == &mesh.attributes.front()) set_bounds(one, mesh.bounds);
        attributes[each.form.name] = add_accessor(std::move(one));
        ids[each.form.name] = each.id;
    }
    Json primitive = primitive_of(std::move(attributes), add_accessor(index_accessor(mesh.triangles)));
    const Json draco{{"bufferView", add_view(mesh.bytes, Json::object())}, {"attributes", ids}};
    primitive["extensions"] = Json{{"KHR_draco_mesh_compression", draco}};
    return primitive;
}

std::size_t GlbDocument::add_mesh(const std::string& name, const Json& primitive) {
    meshes_.push_back(Json{{"name", name}, {"primitives", Json::array({primitive})}});
    return meshes_.size() - 1;
}

void GlbDocument::require_extension(const char* name) {
    if (std::find(extensions_.begin(), extensions_.end(), name) == extensions_.end()) extensions_.push_back(name);
}

}  // namespace meniscus::files
