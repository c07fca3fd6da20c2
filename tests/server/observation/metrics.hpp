// What a server's /metrics says.
#pragma once

#include <map>
#include <sstream>
#include <string>

#include "observation/http_client.hpp"

namespace meniscus::server::test {

/// Samples by their names with labels, as "meniscus_calls_total{code=\"OK\"}".
using Samples = std::map<std::string, double>;

inline Samples scrape(const std::string& http_address) {
    Samples samples;
    std::istringstream text(http_get(http_address, "/metrics").body);
    for (std::string line; std::getline(text, line);) {
        if (line.empty() || line.front() == '#') continue;
        const std::size_t space = line.rfind(' ');
        samples[line.substr(0, space)] = std::stod(line.substr(space + 1));
    }
    return samples;
}

/// The first scrape in which the sample has this value: a client has its answer a moment before it is counted. For ever
/// if that never comes; the test's time limit ends it.
inline Samples scrape_until(const std::string& http_address, const std::string& sample, double value) {
    for (;;) {
        Samples samples = scrape(http_address);
        const auto found = samples.find(sample);
        if (found != samples.end() && found->second == value) return samples;
    }
}

}  // namespace meniscus::server::test
