// A simulation's run with Catalyst, for tests: the five calls, and the tree that a frame is.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "conduit_stand_in.hpp"

namespace meniscus::test {

/// The implementation under test, loaded once.
inline const catalyst_impl& implementation() {
    static const CatalystStandIn loaded = [] {
        ::setenv("CATALYST_IMPLEMENTATION_NAME", "meniscus", 1);
        ::setenv("CATALYST_IMPLEMENTATION_PATHS", MENISCUS_CATALYST_ALONE, 1);
        return CatalystStandIn();
    }();
    return *loaded;
}

/// Sets MENISCUS_CATALYST.
inline void set_options(const std::string& options) {
    ::setenv("MENISCUS_CATALYST", options.c_str(), 1);
}

/// A number of meniscus_result, as a status has it.
inline int status_of(int result) {
    return 200 - result;
}

inline int initialize(conduit_node& params) {
    return implementation().initialize(&params);
}
inline int initialize() {
    conduit_node params;
    return initialize(params);
}
inline int execute(conduit_node& params) {
    return implementation().execute(&params);
}
inline int finalize() {
    conduit_node params;
    return implementation().finalize(&params);
}

struct Results {
    std::string place;  ///< the session, or the folder of files
    std::int64_t sent = 0;
    std::int64_t left_out = 0;
};
inline Results results() {
    conduit_node params;
    EXPECT_EQ(implementation().results(&params), catalyst_status_ok);
    const auto number = [&](const char* path) {
        return *reinterpret_cast<const std::int64_t*>(params.find(path)->data);
    };
    const auto* place = params.find("meniscus/session");
    if (place == nullptr) place = params.find("meniscus/output");
    return {reinterpret_cast<const char*>(place->data), number("meniscus/frames_sent"),
            number("meniscus/frames_left_out")};
}

/// A channel's mesh of points, without coordinates yet.
inline conduit_node& channel_of_points(conduit_node& params, const std::string& channel) {
    conduit_node& root = params["catalyst/channels/" + channel];
    root["type"].set(std::string("mesh"));
    conduit_node& mesh = root["data"];
    mesh["coordsets/coords/type"].set(std::string("explicit"));
    mesh["topologies/particles/type"].set(std::string("points"));
    mesh["topologies/particles/coordset"].set(std::string("coords"));
    return mesh;
}

/// The same, with the frame's state.
inline conduit_node& points_mesh(conduit_node& params, std::int64_t timestep, const std::string& channel = "fluid") {
    params["catalyst/state/timestep"].set(timestep);
    params["catalyst/state/time"].set(0.5 * static_cast<double>(timestep));
    return channel_of_points(params, channel);
}

/// Borrows x y z of each particle, together.
inline void set_positions(conduit_node& mesh, const std::vector<float>& positions) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        mesh["coordsets/coords/values/" + std::string(1, "xyz"[axis])].point(positions.data(), positions.size() / 3,
                                                                             axis * sizeof(float), 3 * sizeof(float));
}

/// A field of the points; its values are to be set.
inline conduit_node& point_field(conduit_node& mesh, const std::string& name) {
    conduit_node& field = mesh["fields/" + name];
    field["association"].set(std::string("vertex"));
    field["topology"].set(std::string("particles"));
    return field["values"];
}

}  // namespace meniscus::test
