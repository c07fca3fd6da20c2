// The flags that become a watcher's options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/client/client.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

struct WatchFlags {
    client::WatchOptions options;         ///< numbers are parsed into it; complete only after build()
    std::optional<int> normal_bits;       ///< none: the options' own
    std::vector<double> region;           ///< empty, or x0 y0 z0 x1 y1 z1
    std::vector<double> viewpoint;        ///< empty, or x y z
    std::vector<std::string> attributes;  ///< names, or "all", or "none"; empty: all
    int attribute_bits = default_attribute_bits;

    void add_to(CLI::App& command);
    /// The flags of the meshes' form alone: normals, attributes, positions, codec and levels. codec_otherwise,
    /// attributes_otherwise: what there is without the flags.
    void add_form_to(CLI::App& command, const std::string& heading, const std::string& codec_otherwise,
                     const std::string& attributes_otherwise);
    /// settings: of the session. Throws InvalidInput for an attribute that it does not have.
    client::WatchOptions build(const Settings& settings) const;
};

}  // namespace meniscus::cli
