// GLB (glTF 2.0): one mesh, its normals and its attributes, plain or compressed by Draco (KHR_draco_mesh_compression).
//
// Positions are float32 around the middle of the mesh; a node puts them in place, by float64. An attribute NAME is
// `_NAME`, uint8 colors are COLOR_0. glTF has no 32-bit integers at vertices: ids are float32 where that holds all of
// them exactly, otherwise two uint16, the low one first.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "files/glb_container.hpp"
#include "formats/atomic_file.hpp"
#include "formats/centered_positions.hpp"
#include "formats/glb_writer.hpp"

namespace meniscus::formats {
namespace {

using Json = nlohmann::ordered_json;

enum ComponentType { unsigned_byte = 5121, unsigned_short = 5123, unsigned_int = 5125, single = 5126 };
constexpr int triangle_list = 4;
enum Target { array_buffer = 34962, element_array_buffer = 34963 };

/// Numbers of the vertices as glTF takes them.
struct VertexData {
    std::string name;  ///< of the attribute in glTF
    ComponentType type = single;
    std::size_t components = 3;
    bool normalized = false;
    std::string bytes;  ///< without gaps between the vertices

    std::size_t component_bytes() const { return type == single ? 4 : type == unsigned_short ? 2 : 1; }
    std::size_t vertex_bytes() const { return components * component_bytes(); }
};

std::string type_name(std::size_t components) {
    return components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
}

template <class Values>
std::string bytes_of(const Values& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

template <class Id>
VertexData ids(const NamedValues& values, std::string name) {
    constexpr std::int64_t exact = 1 << 24;
    std::vector<Id> list(values.count());
    std::memcpy(list.data(), values.data.data(), values.data.size());
    if (std::all_of(list.begin(), list.end(),
                    [](Id id) { return std::int64_t{id} <= exact && std::int64_t{id} >= -exact; }))
        return {std::move(name), single, 1, false, bytes_of(std::vector<float>(list.begin(), list.end()))};
    return {std::move(name), unsigned_short, 2, false, bytes_of(list)};
}

VertexData vertex_data(const NamedValues& values) {
    std::string name = "_";
    for (const char c : values.name) name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    switch (values.type) {
        case ElementType::float32:
            return {std::move(name), single, values.components, false, bytes_of(values.data)};
        case ElementType::uint8:
            if (values.components > 1 && values.name == "color")
                return {"COLOR_0", unsigned_byte, values.components, true, bytes_of(values.data)};
            return {std::move(name), unsigned_byte, values.components, false, bytes_of(values.data)};
        case ElementType::int32:
            return ids<std::int32_t>(values, std::move(name));
        case ElementType::uint32:
            return ids<std::uint32_t>(values, std::move(name));
    }
    return {};
}

/// glTF knows neither infinities nor not-a-numbers. Whether all are finite.
bool is_finite(const VertexData& data) {
    if (data.type != single) return true;
    for (std::size_t i = 0; i + 4 <= data.bytes.size(); i += 4) {
        float value = 0.0F;
        std::memcpy(&value, data.bytes.data() + i, sizeof value);
        if (!std::isfinite(value)) return false;
    }
    return true;
}

std::vector<VertexData> all_vertex_data(const TriangleMesh& mesh, const std::vector<std::array<float, 3>>& positions) {
    std::vector<VertexData> all;
    all.push_back({"POSITION", single, 3, false, bytes_of(positions)});
    if (mesh.normals.size() == positions.size()) all.push_back({"NORMAL", single, 3, false, bytes_of(mesh.normals)});
    for (const NamedValues& attribute : mesh.attributes)
        if (VertexData data = vertex_data(attribute); is_finite(data)) all.push_back(std::move(data));
    return all;
}

/// The one buffer, and the views of its parts.
struct Buffer {
    std::string bytes;
    Json views = Json::array();

    /// Returns the view's index.
    std::size_t add(std::string_view part, const Json& properties) {
        bytes.resize((bytes.size() + files::glb_alignment - 1) / files::glb_alignment * files::glb_alignment);
        Json view{{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", part.size()}};
        view.update(properties);
        views.push_back(std::move(view));
        bytes += part;
        return views.size() - 1;
    }
};

/// Every vertex at a multiple of four bytes, as glTF wants it.
std::string padded(const VertexData& data, std::size_t stride) {
    const std::size_t size = data.vertex_bytes();
    if (size == stride) return data.bytes;
    std::string out;
    out.reserve(data.bytes.size() / size * stride);
    for (std::size_t i = 0; i < data.bytes.size(); i += size) {
        out.append(data.bytes, i, size);
        out.append(stride - size, '\0');
    }
    return out;
}

Json accessor(const VertexData& data, std::size_t count) {
    Json out{{"componentType", static_cast<int>(data.type)}, {"count", count}, {"type", type_name(data.components)}};
    if (data.normalized) out["normalized"] = true;
    return out;
}

Json index_accessor(std::size_t triangles) {
    return Json{{"componentType", static_cast<int>(unsigned_int)}, {"count", 3 * triangles}, {"type", "SCALAR"}};
}

void add_bounds(Json& accessor, const std::vector<std::array<float, 3>>& positions) {
    std::array<float, 3> low = positions.front(), high = low;
    for (const auto& p : positions)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    accessor["min"] = low;
    accessor["max"] = high;
}

Json plain_primitive(const TriangleMesh& mesh, const std::vector<VertexData>& all, Buffer& buffer, Json& accessors) {
    Json attributes;
    for (const VertexData& data : all) {
        const std::size_t stride =
            (data.vertex_bytes() + files::glb_alignment - 1) / files::glb_alignment * files::glb_alignment;
        Json one = accessor(data, mesh.positions.size());
        one["bufferView"] =
            buffer.add(padded(data, stride), Json{{"byteStride", stride}, {"target", static_cast<int>(array_buffer)}});
        attributes[data.name] = accessors.size();
        accessors.push_back(std::move(one));
    }
    const std::size_t indices = accessors.size();
    const std::size_t view =
        buffer.add(bytes_of(mesh.triangles), Json{{"target", static_cast<int>(element_array_buffer)}});
    Json corners = index_accessor(mesh.triangles.size());
    corners["bufferView"] = view;
    accessors.push_back(std::move(corners));
    return Json{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", triangle_list}};
}

draco::DataType draco_type(ComponentType type) {
    return type == single ? draco::DT_FLOAT32 : type == unsigned_short ? draco::DT_UINT16 : draco::DT_UINT8;
}

draco::GeometryAttribute::Type draco_kind(const std::string& name) {
    if (name == "POSITION") return draco::GeometryAttribute::POSITION;
    if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
    return name == "COLOR_0" ? draco::GeometryAttribute::COLOR : draco::GeometryAttribute::GENERIC;
}

Json draco_primitive(const TriangleMesh& mesh, const std::vector<VertexData>& all, Buffer& buffer, Json& accessors) {
    // A lattice of 2^16 points a side over the mesh; normals as fine as they are seen.
    constexpr int position_bits = 16, normal_bits = 10;
    draco::Mesh coded;
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    coded.set_num_points(count);
    coded.SetNumFaces(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        coded.SetFace(draco::FaceIndex(t), {{draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)}});
    }
    Json ids;
    for (const VertexData& data : all) {
        draco::GeometryAttribute attribute;
        attribute.Init(draco_kind(data.name), nullptr, static_cast<std::uint8_t>(data.components),
                       draco_type(data.type), data.normalized, static_cast<std::int64_t>(data.vertex_bytes()), 0);
        const int id = coded.AddAttribute(attribute, true, count);
        for (std::uint32_t v = 0; v < count; ++v)
            coded.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                                   data.bytes.data() + v * data.vertex_bytes());
        ids[data.name] = coded.attribute(id)->unique_id();
    }
    draco::ExpertEncoder encoder(coded);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetTrackEncodedProperties(true);
    encoder.SetAttributeQuantization(0, position_bits);
    if (all.size() > 1 && all[1].name == "NORMAL") encoder.SetAttributeQuantization(1, normal_bits);
    draco::EncoderBuffer encoded;
    const draco::Status status = encoder.EncodeToBuffer(&encoded);
    if (!status.ok()) throw std::runtime_error("Draco could not encode the mesh: " + status.error_msg_string());

    Json attributes;
    for (const VertexData& data : all) {
        attributes[data.name] = accessors.size();
        accessors.push_back(accessor(data, encoder.num_encoded_points()));
    }
    const std::size_t indices = accessors.size();
    accessors.push_back(index_accessor(encoder.num_encoded_faces()));
    const std::size_t view = buffer.add({encoded.data(), encoded.size()}, Json::object());
    const Json draco{{"bufferView", view}, {"attributes", ids}};
    return Json{{"attributes", attributes},
                {"indices", indices},
                {"material", 0},
                {"mode", triangle_list},
                {"extensions", Json{{"KHR_draco_mesh_compression", draco}}}};
}

}  // namespace

std::string to_glb(const TriangleMesh& mesh, GlbCoding coding) {
    Json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "Meniscus"}};
    document["scene"] = 0;
    // The format has no empty lists: a file without a surface has none at all.
    if (mesh.triangles.empty()) {
        document["scenes"] = Json::array({Json{{"name", "no surface"}}});
        return files::glb_container(document.dump(), {});
    }
    if (coding == GlbCoding::draco)
        for (const char* list : {"extensionsUsed", "extensionsRequired"})
            document[list] = Json::array({"KHR_draco_mesh_compression"});
    const CenteredPositions centered(mesh);
    const std::vector<VertexData> all = all_vertex_data(mesh, centered.positions);
    Buffer buffer;
    Json accessors = Json::array();
    Json primitive = coding == GlbCoding::draco ? draco_primitive(mesh, all, buffer, accessors)
                                                : plain_primitive(mesh, all, buffer, accessors);
    add_bounds(accessors[0], centered.positions);
    document["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
    document["nodes"] = Json::array({Json{{"name", "surface"}, {"mesh", 0}, {"translation", centered.middle}}});
    document["meshes"] = Json::array({Json{{"name", "surface"}, {"primitives", Json::array({primitive})}}});
    const Json look{{"baseColorFactor", {0.1, 0.38, 0.5, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.1}};
    document["materials"] = Json::array({Json{{"name", "water"}, {"pbrMetallicRoughness", look}}});
    document["accessors"] = accessors;
    document["bufferViews"] = buffer.views;
    document["buffers"] = Json::array({Json{{"byteLength", buffer.bytes.size()}}});
    return files::glb_container(document.dump(), buffer.bytes);
}

void write_glb(const std::filesystem::path& path, const TriangleMesh& mesh, GlbCoding coding) {
    write_file(path, to_glb(mesh, coding));
}

}  // namespace meniscus::formats
