#include "support.hpp"

#include "meniscus/reconstructor.hpp"

namespace meniscus::fuzz {

namespace {

/// Bytes that are finite as float32, too.
void add_attribute(Mesh& mesh, const char* name, ElementType type, std::size_t components) {
    MeshAttribute& attribute = mesh.attributes.emplace_back();
    attribute.name = name;
    attribute.type = type;
    attribute.components = components;
    attribute.data.resize(mesh.vertices.size() * attribute.element_bytes());
    for (std::size_t i = 0; i < attribute.data.size(); ++i) attribute.data[i] = static_cast<std::byte>(i % 61);
}

}  // namespace

Mesh sample_mesh(bool attributes) {
    // Two drops of different size, one on the border between two bricks.
    constexpr float spacing = 0.2F;
    std::vector<float> positions{3.0F, 3.0F, 3.0F};
    for (int i = 0; i < 27; ++i)
        for (const int step : {i % 3, i / 3 % 3, i / 9})
            positions.push_back(spacing * static_cast<float>(step) - spacing);
    ParticleFrame frame;
    frame.positions = positions;
    Settings settings;
    settings.particle_radius = 0.1;
    settings.cell_size = 1.0;
    BackendOptions options{.backend = Backend::cpu, .threads = 1};
    options.keep_lattice = true;
    Mesh mesh;
    Reconstructor(settings, options).reconstruct(frame, mesh);
    if (attributes) {
        add_attribute(mesh, "velocity", ElementType::float32, 3);
        add_attribute(mesh, "color", ElementType::uint8, 4);
        add_attribute(mesh, "id", ElementType::uint32, 1);
    }
    return mesh;
}

}  // namespace meniscus::fuzz
