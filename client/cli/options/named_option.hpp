// An option that takes one of the names of a choice.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/names.hpp"

namespace meniscus::cli {

/// given: set when the option is; outlives the parsing. Without a default that --help could show.
template <class T>
CLI::Option* add_named_option(CLI::App& command, const std::string& flag, std::optional<T>& given,
                              const std::string& description) {
    return command
        .add_option_function<std::string>(
            flag, [&given, flag](const std::string& name) { given = by_name<T>(name, flag); }, description)
        ->check(CLI::IsMember(std::vector<std::string>(names<T>.begin(), names<T>.end())));
}

/// given: set when the option is; outlives the parsing. otherwise: the default that --help shows.
template <class T, class Given>
CLI::Option* add_named_option(CLI::App& command, const std::string& flag, Given& given, const T& otherwise,
                              const std::string& description) {
    return command
        .add_option_function<std::string>(
            flag, [&given, flag](const std::string& name) { given = by_name<T>(name, flag); }, description)
        ->check(CLI::IsMember(std::vector<std::string>(names<T>.begin(), names<T>.end())))
        ->default_str(std::string(name_of(otherwise)));
}

/// value: outlives the parsing; its present value is the default.
template <class T>
CLI::Option* add_named_option(CLI::App& command, const std::string& flag, T& value, const std::string& description) {
    return add_named_option<T>(command, flag, value, value, description);
}

}  // namespace meniscus::cli
