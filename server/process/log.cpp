#include "process/log.hpp"

#include <fmt/chrono.h>
#include <spdlog/formatter.h>
#include <spdlog/pattern_formatter.h>

#include <chrono>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

namespace meniscus::server {

namespace {

/// The subject of the line that this thread is logging: spdlog hands a message to the formatter in the same thread.
thread_local const LogSubject* current_subject = nullptr;

std::string_view view(spdlog::string_view_t text) {
    return {text.data(), text.size()};
}

/// "session ID, frame N: ".
class SubjectFlag final : public spdlog::custom_flag_formatter {
public:
    void format(const spdlog::details::log_msg& /*message*/, const std::tm& /*time*/,
                spdlog::memory_buf_t& out) override {
        if (current_subject == nullptr) return;
        fmt::format_to(std::back_inserter(out), "session {}", current_subject->session);
        if (current_subject->frame) fmt::format_to(std::back_inserter(out), ", frame {}", *current_subject->frame);
        fmt::format_to(std::back_inserter(out), ": ");
    }
    std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<SubjectFlag>(); }
};

class JsonFormatter final : public spdlog::formatter {
public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
        const auto milliseconds =
            std::chrono::floor<std::chrono::milliseconds>(message.time).time_since_epoch().count() % 1000;
        const std::time_t seconds = spdlog::log_clock::to_time_t(message.time);
        nlohmann::ordered_json line{
            {"time", fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds), milliseconds)},
            {"level", view(spdlog::level::to_string_view(message.level))}};
        if (current_subject != nullptr) line["session"] = current_subject->session;
        if (current_subject != nullptr && current_subject->frame) line["frame"] = *current_subject->frame;
        line["message"] = view(message.payload);
        // A path or a GPU's message need not be UTF-8.
        const std::string text = line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
        out.append(text);
        out.push_back('\n');
    }
    std::unique_ptr<formatter> clone() const override { return std::make_unique<JsonFormatter>(); }
};

}  // namespace

void use_log_format(LogFormat format) {
    if (format == LogFormat::json) {
        spdlog::set_formatter(std::make_unique<JsonFormatter>());
        return;
    }
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<SubjectFlag>('*').set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %*%v");
    spdlog::set_formatter(std::move(formatter));
}

void use_log_level(LogLevel level) {
    const auto level_of_spdlog = [level] {
        switch (level) {
            case LogLevel::debug:
                return spdlog::level::debug;
            case LogLevel::info:
                return spdlog::level::info;
            case LogLevel::warning:
                return spdlog::level::warn;
            case LogLevel::error:
                return spdlog::level::err;
            case LogLevel::off:
                break;
        }
        return spdlog::level::off;
    };
    spdlog::set_level(level_of_spdlog());
}

void log(spdlog::level::level_enum level, const LogSubject& subject, const std::string& message) {
    current_subject = &subject;
    spdlog::log(level, "{}", message);
    current_subject = nullptr;
}

}  // namespace meniscus::server
