#include "crowds.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace meniscus::hostile {

namespace {

void add(Positions& positions, float x, float y, float z) {
    for (const float p : {x, y, z}) positions.push_back(p);
}

}  // namespace

Positions evenly_spread(int count, float apart) {
    const int side = static_cast<int>(std::ceil(std::cbrt(count)));
    Positions positions;
    for (int i = 0; i < count; ++i) {
        const int layer = i / side / side;
        add(positions, apart * static_cast<float>(i % side), apart * static_cast<float>(i / side % side),
            apart * static_cast<float>(layer));
    }
    return positions;
}

Positions clumps(int number, int of, float size) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-size, size);
    Positions positions;
    for (int c = 0; c < number; ++c) {
        const int row = c / 16;
        for (int i = 0; i < of; ++i)
            add(positions, 50.0F * static_cast<float>(c % 16) + place(random),
                50.0F * static_cast<float>(row) + place(random), place(random));
    }
    return positions;
}

Positions together(Positions a, const Positions& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Settings settings_of(Field field, double cell_size, Mode mode) {
    Settings settings;
    settings.particle_radius = 1.0;
    settings.field = field;
    settings.cell_size = cell_size;
    settings.mode = mode;
    return settings;
}

Case clumps_among_small(Field field, int number, int half) {
    Case mixed{std::to_string(number) + " clumps of large particles among small ones, " + std::string(name_of(field)),
               settings_of(field, 0.5, Mode::adaptive),
               together(evenly_spread(half), clumps(number, half / number, 8.0F))};
    mixed.levels.assign(mixed.positions.size() / 3, 3);
    std::fill_n(mixed.levels.begin(), half, std::uint8_t{0});
    return mixed;
}

void send(client::Client& client, const std::string& session, const Case& attack) {
    client::Stream stream = client.stream(session, {.receive_meshes = false});
    ParticleFrame frame;
    frame.positions = attack.positions;
    frame.levels = attack.levels;
    stream.push(frame, 0, 0.0);
    static_cast<void>(stream.next());
}

}  // namespace meniscus::hostile
