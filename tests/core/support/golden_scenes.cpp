#include "support/golden_scenes.hpp"

#include <array>

namespace meniscus::test {
namespace {

/// A place in ticks of 2^-12 world units.
using Point = std::array<int, 3>;

/// The distance of neighbors in calm water: two radii of 0.025, rounded to whole ticks.
constexpr int spacing = 205;

/// Numbers without a pattern: the state is a Weyl sequence, the output is mixed as in MurmurHash3.
class Noise {
public:
    explicit Noise(std::uint32_t seed) : state_(seed) {}

    std::uint32_t next() {
        state_ += 0x9E3779B9U;
        std::uint32_t h = state_;
        h = (h ^ (h >> 16)) * 0x85EBCA6BU;
        h = (h ^ (h >> 13)) * 0xC2B2AE35U;
        return h ^ (h >> 16);
    }
    /// A number of a range, both ends included.
    int between(int low, int high) {
        return low + static_cast<int>(next() % static_cast<std::uint32_t>(high - low + 1));
    }
    Point near(const Point& p, int distance) {
        Point moved = p;
        for (int& coordinate : moved) coordinate += between(-distance, distance);
        return moved;
    }

private:
    std::uint32_t state_;
};

void add(Particles& particles, const Point& p) {
    const auto world = [](int ticks) { return static_cast<float>(ticks) / 4096.0F; };
    particles.add(world(p[0]), world(p[1]), world(p[2]));
}

/// Particles on a cubic grid, the first one at `origin`.
void add_block(Particles& particles, const Point& origin, const Point& count, int distance, int jitter, Noise& noise) {
    for (int z = 0; z < count[2]; ++z)
        for (int y = 0; y < count[1]; ++y)
            for (int x = 0; x < count[0]; ++x)
                add(particles,
                    noise.near({origin[0] + x * distance, origin[1] + y * distance, origin[2] + z * distance}, jitter));
}

/// A ball of particles, its radius in particles.
void add_drop(Particles& particles, const Point& center, int radius, Noise& noise) {
    for (int z = -radius; z <= radius; ++z)
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x)
                if (x * x + y * y + z * z <= radius * radius)
                    add(particles,
                        noise.near({center[0] + x * spacing, center[1] + y * spacing, center[2] + z * spacing}, 20));
}

Particles splash() {
    Particles particles;
    Noise noise(1);
    add_block(particles, {0, 0, 0}, {7, 4, 7}, spacing, 60, noise);
    for (int i = 0; i < 16; ++i)
        add(particles, {noise.between(-700, 2100), noise.between(-300, 2100), noise.between(-700, 2100)});
    return particles;
}

Particles slab() {
    Particles particles;
    Noise noise(2);
    add_block(particles, {-1500, 37, -900}, {14, 4, 10}, spacing, 0, noise);
    return particles;
}

Particles drops() {
    Particles particles;
    Noise noise(3);
    add_drop(particles, {-3000, 500, 700}, 1, noise);
    add_drop(particles, {-1700, 411, 603}, 2, noise);
    add_drop(particles, {409, -277, 900}, 3, noise);
    return particles;
}

/// Particles alone, in pairs, on top of each other, on a lattice point, far away.
Particles lone() {
    Particles particles;
    for (const Point& p : {Point{0, 0, 0}, Point{2048, 3, -700}, Point{2148, 3, -700}, Point{-2000, 777, 1024},
                           Point{-2000, 777, 1024}, Point{-2000, 777, 1025}, Point{400000, -300000, 200000}})
        add(particles, p);
    return particles;
}

/// Blocks of all four particle levels side by side: level k has 2^k times the radius.
Particles levels() {
    Particles particles;
    Noise noise(4);
    int x = 0;
    for (int level = 0; level < 4; ++level) {
        const int distance = spacing << level;
        const int count = level == 0 ? 6 : level == 1 ? 3 : level == 2 ? 2 : 1;
        add_block(particles, {x, 0, 0}, {count, count, count}, distance, distance / 5, noise);
        x += count * distance + distance / 2;
        particles.levels.resize(particles.count(), static_cast<std::uint8_t>(level));
    }
    add(particles, {-500, 900, 300});
    particles.levels.push_back(0);
    add(particles, {1400, 2500, 600});
    particles.levels.push_back(1);
    return particles;
}

/// A jittered block over a box of 65,535 steps an axis, its lengths no powers of two.
GoldenScene quantized() {
    GoldenScene scene{"quantized", {}, {}, {{-0.125, -0.0625, -0.3125}, {0.1875, 0.125, 0.09375}}};
    Noise noise(5);
    for (int z = 0; z < 7; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x)
                for (const int q : noise.near({4000 + x * 10000, 2000 + y * 17000, 3000 + z * 8500}, 1900))
                    scene.quantized.push_back(static_cast<std::uint16_t>(q));
    return scene;
}

}  // namespace

ParticleFrame GoldenScene::frame() const {
    ParticleFrame frame = particles.frame();
    frame.quantized = quantized;
    frame.quantization_box = quantization_box;
    return frame;
}

std::vector<GoldenScene> golden_scenes() {
    return {{"splash", splash(), {}, {}}, {"slab", slab(), {}, {}},     {"drops", drops(), {}, {}},
            {"lone", lone(), {}, {}},     {"levels", levels(), {}, {}}, quantized()};
}

}  // namespace meniscus::test
