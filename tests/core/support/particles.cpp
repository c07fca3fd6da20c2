#include "support/particles.hpp"

#include "meniscus/reconstructor.hpp"

namespace meniscus::test {

ParticleFrame Particles::frame() const {
    ParticleFrame frame;
    frame.positions = positions;
    frame.levels = levels;
    return frame;
}

Mesh reconstruct(const Settings& settings, const ParticleFrame& frame, unsigned threads) {
    BackendOptions options{.backend = Backend::cpu, .threads = threads};
    options.keep_lattice = true;
    Reconstructor reconstructor(settings, options);
    Mesh mesh;
    reconstructor.reconstruct(frame, mesh);
    return mesh;
}

Settings default_settings() {
    Settings settings;
    settings.particle_radius = 0.025;
    return settings;
}

Particles splash(unsigned seed, int side, float radius) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> jitter(-0.3F, 0.3F);
    std::uniform_real_distribution<float> place(-0.5F, 1.5F);
    Particles particles;
    const float spacing = 2.0F * radius;
    const float edge = spacing * static_cast<float>(side);
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side / 2; ++y)
            for (int x = 0; x < side; ++x)
                particles.add((static_cast<float>(x) + jitter(random)) * spacing,
                              (static_cast<float>(y) + jitter(random)) * spacing,
                              (static_cast<float>(z) + jitter(random)) * spacing);
    for (int drop = 0; drop < side * side / 4; ++drop)
        particles.add(place(random) * edge, place(random) * edge, place(random) * edge);
    return particles;
}

std::vector<NamedParticles> adversarial(float r) {
    std::mt19937 random(11);
    std::vector<NamedParticles> all;
    const auto add = [&](const char* name) -> Particles& {
        return all.emplace_back(NamedParticles{name, {}}).particles;
    };

    add("one particle").add(0.3F * r, 0.7F * r, -0.2F * r);
    Particles& coincident = add("coincident particles");
    for (int i = 0; i < 40; ++i) coincident.add(r, r, r);
    Particles& line = add("collinear particles along x");
    for (int i = 0; i < 60; ++i) line.add(static_cast<float>(i) * 1.3F * r, 0.0F, 0.0F);
    Particles& diagonal = add("collinear particles along a diagonal");
    for (int i = 0; i < 60; ++i)
        diagonal.add(static_cast<float>(i) * r, static_cast<float>(i) * r, static_cast<float>(i) * r);
    Particles& sheet = add("a flat sheet through lattice points");
    for (int i = 0; i < 14; ++i)
        for (int j = 0; j < 14; ++j)
            sheet.add(static_cast<float>(i) * 2.0F * r, static_cast<float>(j) * 2.0F * r, 0.0F);
    Particles& tilted = add("a sheet almost parallel to the grid");
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            tilted.add(static_cast<float>(i) * 1.6F * r, static_cast<float>(j) * 1.6F * r,
                       static_cast<float>(i) * 0.03F * r);
    Particles& corners = add("particles on base vertices");
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 6; ++k)
                corners.add(static_cast<float>(i) * 4.0F * r, static_cast<float>(j) * 4.0F * r,
                            static_cast<float>(k) * 4.0F * r);
    Particles& far = add("far from the origin");
    const float away = 1e5F * r;
    std::uniform_real_distribution<float> near(-6.0F * r, 6.0F * r);
    for (int i = 0; i < 200; ++i) far.add(away + near(random), -away + near(random), away + near(random));
    Particles& apart = add("two drops far apart");
    apart.add(-1e5F * r, 0.0F, 0.0F);
    apart.add(1e5F * r, 3.0F * r, 0.0F);
    Particles& cloud = add("a random cloud");
    std::uniform_real_distribution<float> wide(-20.0F * r, 20.0F * r);
    for (int i = 0; i < 1500; ++i) cloud.add(wide(random), wide(random), wide(random));
    Particles& borders = add("drops around a brick's corner");
    for (int i = 0; i < 8; ++i)
        borders.add((static_cast<float>(i & 1) - 0.5F) * r, (static_cast<float>(i >> 1 & 1) - 0.5F) * r,
                    (static_cast<float>(i >> 2) - 0.5F) * r);
    return all;
}

}  // namespace meniscus::test
