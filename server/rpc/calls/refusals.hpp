// Calls that the server has refused: counted by reason and name, and logged at a limited rate.
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "process/line_limit.hpp"
#include "sessions/sending/metrics.hpp"

namespace meniscus::server {

/// Thread-safe.
class Refusals {
public:
    explicit Refusals(std::shared_ptr<Metrics> metrics) : metrics_(std::move(metrics)) {}

    /// name: of the caller's token; empty where there is none. peer: its address. Does nothing without an error, and
    /// for one that is no refusal.
    void report(const std::exception_ptr& error, const std::string& name, const std::string& peer);

private:
    const std::shared_ptr<Metrics> metrics_;
    LineLimit lines_{20};
};

}  // namespace meniscus::server
