// The maker of the normals of received meshes.
#pragma once

#include <string_view>

#include "meniscus/names.hpp"

namespace meniscus::client {

/// The receiver's own take no bytes. ReceivedFrame::mesh() computes them from the triangles
/// (meniscus/mesh_normals.hpp), also where the session has none; in splashes they are some degrees off those of the
/// field.
enum class NormalsBy {
    server,    ///< of the field, rounded to normal_bits; none if the session's settings leave them out
    receiver,  ///< of the triangles; normal_bits does not count, and none are sent
};
constexpr std::string_view name_of(NormalsBy by) {
    switch (by) {
        case NormalsBy::server:
            return "server";
        case NormalsBy::receiver:
            return "receiver";
    }
    return {};
}

/// The bits to ask a server for.
constexpr int asked_normal_bits(NormalsBy by, int normal_bits) {
    return by == NormalsBy::receiver ? 0 : normal_bits;
}

}  // namespace meniscus::client
