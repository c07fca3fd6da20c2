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
    client::WatchOptions options;                ///< numbers are parsed into it; complete only after build()
    std::optional<int> normal_bits;              ///< none: the options' own
    std::vector<double> region;                  ///< empty, or x0 y0 z0 x1 y1 z1
    std::vector<double> viewpoint;               ///< empty, or x y z
    std::vector<std::string> attributes{"all"};  ///< names, or "all", or "none"
    int attribute_bits = default_attribute_bits;

    void add_to(CLI::App& command);
    /// settings: of the session. Throws InvalidInput for an attribute that it does not have.
    client::WatchOptions build(const Settings& settings) const;
};

}  // namespace meniscus::cli
