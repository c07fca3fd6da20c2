// The flags that become a watcher's wishes.
#pragma once

#include <vector>

#include "meniscus/client/client.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

struct WatchWishes {
    client::WatchOptions options;   ///< numbers are parsed into it; complete only after build()
    std::vector<double> region;     ///< empty, or x0 y0 z0 x1 y1 z1
    std::vector<double> viewpoint;  ///< empty, or x y z
    double reconnect = 0.0;         ///< seconds

    void add_to(CLI::App& command);
    client::WatchOptions build() const;
};

}  // namespace meniscus::cli
