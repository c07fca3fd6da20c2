// Frames whose particles crowd together, and evenly spread ones beside them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::hostile {

using Positions = std::vector<float>;  ///< x y z each

/// A cube of particles, `apart` from each other along each axis.
Positions evenly_spread(int count, float apart = 2.0F);

/// `number` clumps of `of` particles each, 50 radii apart; a particle lies up to `size` from its clump's middle on each
/// axis.
Positions clumps(int number, int of, float size);

Positions together(Positions a, const Positions& b);

/// Of particles with a radius of 1.
Settings settings_of(Field field, double cell_size, Mode mode);

/// A frame of an attack.
struct Case {
    std::string name;
    Settings settings;
    Positions positions;
    std::vector<std::uint8_t> levels = {};  ///< none: all 0
};

/// half particles of level 0, evenly spread, and as many of level 3 in this number of clumps.
Case clumps_among_small(Field field, int number, int half);

/// Sends the frame alone, and waits for its answer. Throws as a stream does for one that is refused or stopped.
void send(client::Client& client, const std::string& session, const Case& attack);

}  // namespace meniscus::hostile
