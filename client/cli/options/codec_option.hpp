// The flag --codec.
#pragma once

#include <optional>
#include <string>

#include "cli/options/named_option.hpp"
#include "meniscus/codec.hpp"

namespace meniscus::cli {

/// codec: outlives the parsing. otherwise: what there is without the flag.
inline CLI::Option* add_codec(CLI::App& command, std::optional<Codec>& codec, const std::string& otherwise) {
    return add_named_option(
        command, "--codec", codec,
        "Codec of the meshes: packed, the fastest, entropy, the smallest, or draco. Default: " + otherwise);
}

}  // namespace meniscus::cli
