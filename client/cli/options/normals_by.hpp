// The flag --normals-by.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/options/named_option.hpp"
#include "meniscus/client/normals_by.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

/// by: outlives the parsing.
inline CLI::Option* add_normals_by(CLI::App& command, client::NormalsBy& by) {
    return add_named_option(
        command, "--normals-by", by,
        "Maker of the normals: server, or receiver, which computes them from the triangles: none are sent, which saves "
        "half of the bytes or more by the codec entropy, and turns them by some degrees in splashes");
}

/// normal_bits: as given. bricks: whether meshes are written as files of bricks. Throws InvalidInput for a receiver's
/// normals where bits are given, or where nothing receives.
inline void check_normals_by(client::NormalsBy by, const std::optional<int>& normal_bits, bool bricks) {
    if (by == client::NormalsBy::server) return;
    if (normal_bits)
        throw InvalidInput(
            "--normal-bits " + std::to_string(*normal_bits) +
            " is of normals that are sent, and --normals-by receiver has none sent: give one of the two");
    if (bricks)
        throw InvalidInput(
            "--normals-by receiver is of decoded meshes, and files of bricks keep what is sent: leave it out, or give "
            "--normal-bits 0 for files without normals");
}

}  // namespace meniscus::cli
