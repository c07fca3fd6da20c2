// The server's log: lines of text or of JSON, with session and frame in fields of their own where a line is about them.
#pragma once

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace meniscus::server {

enum class LogFormat { text, json };
constexpr std::string_view name_of(LogFormat format) {
    switch (format) {
        case LogFormat::text:
            return "text";
        case LogFormat::json:
            return "json";
    }
    return {};
}

/// The least important lines that are logged.
enum class LogLevel { debug, info, warning, error, off };
constexpr std::string_view name_of(LogLevel level) {
    switch (level) {
        case LogLevel::debug:
            return "debug";
        case LogLevel::info:
            return "info";
        case LogLevel::warning:
            return "warning";
        case LogLevel::error:
            return "error";
        case LogLevel::off:
            return "off";
    }
    return {};
}

/// Both are of spdlog's default logger, which all lines go through.
void use_log_format(LogFormat format);
void use_log_level(LogLevel level);

/// The subject of a line.
struct LogSubject {
    std::string_view session = {};
    std::optional<std::uint64_t> frame = {};
};

void log(spdlog::level::level_enum level, const LogSubject& subject, const std::string& message);

template <class... Args>
void log_info(const LogSubject& subject, fmt::format_string<Args...> text, Args&&... args) {
    log(spdlog::level::info, subject, fmt::format(text, std::forward<Args>(args)...));
}

template <class... Args>
void log_warning(const LogSubject& subject, fmt::format_string<Args...> text, Args&&... args) {
    log(spdlog::level::warn, subject, fmt::format(text, std::forward<Args>(args)...));
}

template <class... Args>
void log_error(const LogSubject& subject, fmt::format_string<Args...> text, Args&&... args) {
    log(spdlog::level::err, subject, fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace meniscus::server
