// An option that takes one of the names of a choice.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/names.hpp"

namespace meniscus::cli {

/// value: outlives the parsing; its present value is the default.
template <class T>
CLI::Option* add_named_option(CLI::App& command, const std::string& flag, T& value, const std::string& description) {
    return command
        .add_option_function<std::string>(
            flag, [&value, flag](const std::string& name) { value = by_name<T>(name, flag); }, description)
        ->check(CLI::IsMember(std::vector<std::string>(names<T>.begin(), names<T>.end())))
        ->default_str(std::string(name_of(value)));
}

}  // namespace meniscus::cli
