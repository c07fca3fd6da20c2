#include "mesh.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "meniscus/mesh_hash.hpp"
#include "result.hpp"

using namespace meniscus::c;

namespace {

/// x y z of each vertex, made once.
template <class Number>
void make_vertices(const meniscus::Mesh& mesh, std::vector<Number>& vertices) {
    if (!vertices.empty()) return;
    vertices.reserve(3 * mesh.vertices.size());
    for (const meniscus::LatticePosition& vertex : mesh.vertices)
        for (const double coordinate : mesh.world(vertex)) vertices.push_back(static_cast<Number>(coordinate));
}

/// The body of a function that gives an array. array_of: from the mesh, a pointer to the first number.
template <class Number, class ArrayOf>
meniscus_result give_array(meniscus_mesh* mesh, const Number** array, const char* name, std::size_t* count,
                           const ArrayOf& array_of) {
    return guarded([&] {
        const Number*& given = required(array, name);
        std::size_t& elements = required(count, "count");
        given = nullptr;
        elements = 0;
        const auto [first, size] = array_of(required(mesh, "mesh"));
        if (size != 0) given = first;
        elements = size;
        return MENISCUS_OK;
    });
}

meniscus_type type_of(meniscus::ElementType type) {
    switch (type) {
        case meniscus::ElementType::float32:
            return MENISCUS_FLOAT32;
        case meniscus::ElementType::uint8:
            return MENISCUS_UINT8;
        case meniscus::ElementType::int32:
            return MENISCUS_INT32;
        case meniscus::ElementType::uint32:
            return MENISCUS_UINT32;
    }
    return MENISCUS_FLOAT32;
}

template <class Number>
struct Given {
    const Number* first;
    std::size_t count;
};

/// The numbers of elements that are arrays of numbers themselves.
template <class Number, class Elements>
Given<Number> numbers_of(const Elements& elements) {
    return {elements.empty() ? nullptr : elements.front().data(), elements.size()};
}

/// hash: of a mesh, as 64 digits.
meniscus_result give_hash(const meniscus_mesh* mesh, char* digits, std::string (*hash)(const meniscus::Mesh&)) {
    return guarded([&] {
        const std::string text = hash(required(mesh, "mesh").content);
        static_assert(MENISCUS_SHA256_SIZE == 64 + 1);
        std::memcpy(&required(digits, "digits"), text.c_str(), MENISCUS_SHA256_SIZE);
        return MENISCUS_OK;
    });
}

}  // namespace

meniscus_result meniscus_mesh_create(meniscus_mesh** mesh) {
    return guarded([&] {
        required(mesh, "mesh") = nullptr;
        *mesh = new meniscus_mesh;
        return MENISCUS_OK;
    });
}

void meniscus_mesh_destroy(meniscus_mesh* mesh) {
    delete mesh;
}

meniscus_result meniscus_mesh_vertices(meniscus_mesh* mesh, const double** vertices, size_t* count) {
    return give_array(mesh, vertices, "vertices", count, [](meniscus_mesh& m) {
        make_vertices(m.content, m.vertices);
        return Given<double>{m.vertices.data(), m.content.vertices.size()};
    });
}

meniscus_result meniscus_mesh_vertices_float(meniscus_mesh* mesh, const float** vertices, size_t* count) {
    return give_array(mesh, vertices, "vertices", count, [](meniscus_mesh& m) {
        make_vertices(m.content, m.vertices_float);
        return Given<float>{m.vertices_float.data(), m.content.vertices.size()};
    });
}

meniscus_result meniscus_mesh_normals(meniscus_mesh* mesh, const float** normals, size_t* count) {
    return give_array(mesh, normals, "normals", count,
                      [](const meniscus_mesh& m) { return numbers_of<float>(m.content.normals); });
}

meniscus_result meniscus_mesh_triangles(meniscus_mesh* mesh, const uint32_t** triangles, size_t* count) {
    return give_array(mesh, triangles, "triangles", count,
                      [](const meniscus_mesh& m) { return numbers_of<std::uint32_t>(m.content.triangles); });
}

meniscus_result meniscus_mesh_triangle_levels(meniscus_mesh* mesh, const uint8_t** levels, size_t* count) {
    return give_array(mesh, levels, "levels", count, [](meniscus_mesh& m) {
        const std::size_t triangles = m.content.triangles.size();
        if (m.triangle_levels.empty()) {
            m.triangle_levels.resize(triangles);
            for (std::size_t level = 0; level < meniscus::triangle_level_count; ++level) {
                const meniscus::TriangleRange& range = m.content.levels[level];
                std::fill_n(m.triangle_levels.begin() + range.first, range.count,
                            meniscus::level_byte(static_cast<meniscus::TriangleLevel>(level)));
            }
        }
        return Given<std::uint8_t>{m.triangle_levels.data(), triangles};
    });
}

meniscus_result meniscus_mesh_spray(meniscus_mesh* mesh, const float** places, size_t* count) {
    return give_array(mesh, places, "places", count,
                      [](const meniscus_mesh& m) { return numbers_of<float>(m.content.spray); });
}

meniscus_result meniscus_mesh_attributes(meniscus_mesh* mesh, const meniscus_array** attributes, size_t* count) {
    return give_array(mesh, attributes, "attributes", count, [](meniscus_mesh& m) {
        if (m.attributes.empty())
            for (const meniscus::MeshAttribute& attribute : m.content.attributes)
                m.attributes.push_back({attribute.name.c_str(), type_of(attribute.type),
                                        static_cast<std::uint32_t>(attribute.components),
                                        attribute.data.empty() ? nullptr : attribute.data.data()});
        return Given<meniscus_array>{m.attributes.data(), m.attributes.size()};
    });
}

meniscus_result meniscus_mesh_sha256(const meniscus_mesh* mesh, char digits[MENISCUS_SHA256_SIZE]) {
    return give_hash(mesh, digits, meniscus::mesh_sha256);
}

meniscus_result meniscus_mesh_bricks_sha256(const meniscus_mesh* mesh, char digits[MENISCUS_SHA256_SIZE]) {
    return give_hash(mesh, digits, meniscus::bricks_sha256);
}
