// Reconstructors and frames of the C interface, for its tests.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "handles.hpp"
#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"

namespace meniscus::test {

inline meniscus_particles c_frame(const Particles& particles) {
    meniscus_particles frame = MENISCUS_PARTICLES_INIT;
    frame.count = particles.count();
    frame.positions = particles.positions.data();
    if (!particles.levels.empty()) frame.levels = particles.levels.data();
    return frame;
}

inline CReconstructor reconstructor_of(std::initializer_list<std::pair<const char*, const char*>> values) {
    const COptions options = options_of(values);
    CReconstructor reconstructor;
    EXPECT_EQ(meniscus_reconstructor_create(options.get(), reconstructor.out()), MENISCUS_OK)
        << meniscus_error_message();
    return reconstructor;
}

inline CReconstructor default_reconstructor() {
    return reconstructor_of({{"particle-radius", "0.025"}, {"threads", "1"}});
}

/// The message with which a reconstructor of these settings besides the radius is refused.
inline std::string refusal_of(std::initializer_list<std::pair<const char*, const char*>> values) {
    COptions options = options_of(values);
    if (meniscus_options_set(options.get(), "particle-radius", "0.025") != MENISCUS_OK) return {};
    CReconstructor reconstructor;
    if (meniscus_reconstructor_create(options.get(), reconstructor.out()) != MENISCUS_INVALID_INPUT) return {};
    EXPECT_EQ(reconstructor.get(), nullptr);
    return meniscus_error_message();
}

}  // namespace meniscus::test
