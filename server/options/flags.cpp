#include "options/flags.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "meniscus/described.hpp"
#include "meniscus/names.hpp"
#include "meniscus/seconds.hpp"
#include "options/validators.hpp"

namespace meniscus::server {

namespace {

std::string flag_of(std::string_view name, const Facts& facts) {
    return "--" + option_name(name, facts);
}

// A flag by the type of its value.

CLI::Option* add(CLI::App& app, const std::string& flag, bool& value, const Facts& facts) {
    return app.add_flag(flag, value, std::string(facts.help));
}

CLI::Option* add(CLI::App& app, const std::string& flag, std::string& value, const Facts& facts) {
    return app.add_option(flag, value, std::string(facts.help))->type_name(std::string(facts.argument));
}

CLI::Option* add(CLI::App& app, const std::string& flag, std::filesystem::path& value, const Facts& facts) {
    return app.add_option(flag, value, std::string(facts.help))
        ->type_name(std::string(facts.argument))
        ->default_str("");
}

template <class Value>
CLI::Option* add(CLI::App& app, const std::string& flag, std::vector<Value>& values, const Facts& facts) {
    CLI::Option* option = app.add_option(flag, values, std::string(facts.help))
                              ->delimiter(',')
                              ->allow_extra_args(false)
                              ->type_name(std::string(facts.argument))
                              ->default_str("");
    if constexpr (std::is_arithmetic_v<Value>) option->check(CLI::NonNegativeNumber);
    return option;
}

/// Without help, the names themselves are the help.
template <class Choice>
requires std::is_enum_v<Choice> CLI::Option* add(CLI::App& app, const std::string& flag, Choice& value,
                                                 const Facts& facts) {
    const std::string what(facts.subject);
    return app
        .add_option_function<std::string>(
            flag, [&value, what](const std::string& name) { value = by_name<Choice>(name, what); },
            facts.help.empty() ? listed(names<Choice>) : std::string(facts.help))
        ->type_name(std::string(facts.argument))
        ->default_str(std::string(name_of(value)));
}

CLI::Option* add(CLI::App& app, const std::string& flag, std::chrono::milliseconds& value, const Facts& facts) {
    return app
        .add_option_function<double>(
            flag, [&value](double seconds) { value = milliseconds_of(seconds); }, std::string(facts.help))
        ->check(seconds_up_to(facts.range.most))
        ->default_str(fmt::format("{}", seconds_of(value)));
}

CLI::Option* add(CLI::App& app, const std::string& flag, double& value, const Facts& facts) {
    return app.add_option(flag, value, std::string(facts.help))->check(up_to(facts.range.most));
}

template <std::integral Number>
CLI::Option* add(CLI::App& app, const std::string& flag, Number& value, const Facts& facts) {
    CLI::Option* option = app.add_option(flag, value, std::string(facts.help));
    if (facts.unit.starts_with("bytes"))
        option->transform(CLI::AsSizeValue(false))->transform(whole_number())->type_name(std::string(facts.argument));
    else if (sizeof(Number) == sizeof(std::uint64_t))
        option->check(whole_number());
    if (std::isfinite(facts.range.most))
        option->check(
            CLI::Range(static_cast<Number>(std::max(facts.range.least, 0.0)), static_cast<Number>(facts.range.most)));
    return option;
}

}  // namespace

void add_flags(CLI::App& app, CommandLine& command_line) {
    CommandLine::rows(command_line, [&app]<class Value>(std::string_view name, Value& value, const Facts& facts,
                                                        const auto&... standard) {
        if constexpr (!std::is_const_v<Value>) {
            if (facts.help.empty() && !std::is_enum_v<Value>) return;
            CLI::Option* option = add(app, flag_of(name, facts), value, facts);
            if (sizeof...(standard) != 0) option->default_str("");
        }
    });
    // Addresses, but for that of HTTP.
    for (const char* address : {"--listen", "--probes"}) app.get_option(address)->type_name("TEXT");
    // An origin at a time.
    app.get_option("--web-origin")->delimiter('\0');
}

void set_defaults_that_follow(const CLI::App& app, CommandLine& command_line) {
    CommandLine::rows(command_line, [&app]<class Value>(std::string_view name, Value& value, const Facts& facts,
                                                        const auto&... standard) {
        const CLI::Option* option = app.get_option_no_throw(flag_of(name, facts));
        if (option == nullptr || option->count() == 0) ((value = standard()), ...);
    });
}

}  // namespace meniscus::server
