// The samples of a server's /metrics.
#pragma once

#include <map>
#include <sstream>
#include <string>

#include "observation/http_client.hpp"

namespace meniscus::server::test {

/// Samples by their names with labels, as "meniscus_limit_number{limit=\"sessions\"}".
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

/// Over the samples whose name begins so and which have this label, as "code=\"OK\"".
inline double sum_of(const Samples& samples, const std::string& name, const std::string& label) {
    double sum = 0.0;
    for (const auto& [sample, value] : samples)
        if (sample.starts_with(name) && sample.find(label) != std::string::npos) sum += value;
    return sum;
}

/// The calls that have ended with this status, as "NotFound".
inline double calls_ended(const Samples& samples, const std::string& code) {
    return sum_of(samples, "grpc_server_handled_total{", "grpc_code=\"" + code + "\"");
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
