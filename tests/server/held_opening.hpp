// A stream that is stopped while the server opens it.
#pragma once

#include <spdlog/sinks/sink.h>
#include <spdlog/spdlog.h>

#include <future>
#include <memory>
#include <string>
#include <string_view>

namespace meniscus::server::test {

/// Holds a thread that logs the opening of a stream until it is released.
class HeldOpening final : public spdlog::sinks::sink {
public:
    void log(const spdlog::details::log_msg& message) override {
        const std::string_view text(message.payload.data(), message.payload.size());
        if (!text.ends_with(" opened")) return;
        held.set_value();
        released.get_future().wait();
    }
    void flush() override {}
    void set_pattern(const std::string& /*pattern*/) override {}
    void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

    std::promise<void> held;
    std::promise<void> released;
};

}  // namespace meniscus::server::test
