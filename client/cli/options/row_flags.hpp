// The flags of a described record (meniscus/described.hpp), by the names of its rows.
#pragma once

#include <CLI/CLI.hpp>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cli/options/option_group.hpp"
#include "meniscus/described.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::cli {

/// The values that were given by flags, to be put over those that a record has already.
template <class Record>
class RowFlags {
public:
    /// A flag for each row that is not shown by hand, under the heading of its group. defaults: for --help.
    void add_to(CLI::App& command, const Record& defaults) {
        given_->clear();
        std::string_view heading;  // of a choice: its parameters stand beside it
        for_each_row<Record>([&]<class Row>(const Row& row) {
            if (row.facts.by_hand) return;
            given_->emplace_back();
            if (!row.facts.group.empty()) heading = row.facts.group;
            const OptionGroup group(command, std::string(heading));
            if constexpr (!is_list<typename Row::Type>) add(command, row, defaults, given_->size() - 1);
        });
    }

    /// In the order of the rows. Throws InvalidInput for a parameter of an alternative that is not chosen.
    void apply(Record& record) const {
        for (const auto& put : *given_)
            if (put) put(record);
    }

private:
    template <class Row>
    void add(CLI::App& command, const Row& row, const Record& defaults, std::size_t place) {
        using Value = Held<typename Row::Type>;
        std::string flags = "--" + option_name(row);
        if (row.facts.letter != '\0') flags = std::string("-") + row.facts.letter + "," + flags;
        std::string help(row.facts.help);
        if (!row.facts.when.empty()) help = "With " + std::string(row.facts.when) + ": " + help;
        if constexpr (std::same_as<Value, bool>) {
            // The last one counts; a flag that is not there changes nothing.
            struct Given {
                bool is_given = false;
                bool value = false;
            };
            const auto last = std::make_shared<Given>();
            command.add_flag(flags + ",!--no-" + option_name(row), last->value, help)->each([last](const std::string&) {
                last->is_given = true;
            });
            (*given_)[place] = [row, last](Record& record) {
                if (last->is_given) *row.find(record) = last->value;
            };
        } else if constexpr (std::same_as<Value, Box>) {
            command
                .add_option_function<std::vector<double>>(
                    flags,
                    [given = given_, row, place](const std::vector<double>& corners) {
                        keep(*given, row, place,
                             Box{{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}});
                    },
                    std::string(row.facts.argument) + ": " + help)
                ->expected(6);
        } else if constexpr (std::is_enum_v<Value> || is_variant<Value>) {
            command
                .add_option_function<std::string>(
                    flags,
                    [given = given_, row, place](const std::string& name) {
                        keep(*given, row, place, by_name<Value>(name, "--" + option_name(row)));
                    },
                    help)
                ->check(CLI::IsMember(std::vector<std::string>(names<Value>.begin(), names<Value>.end())))
                ->default_str(std::string(name_of(standard(row, defaults))));
        } else {
            command
                .add_option_function<std::optional<Value>>(
                    flags,
                    [given = given_, row, place](const std::optional<Value>& value) {
                        if (value) keep(*given, row, place, *value);
                    },
                    help)
                ->default_str(text_of(standard(row, defaults)));
        }
    }

    /// An element of each row; empty where the flag was not given.
    using Puts = std::vector<std::function<void(Record&)>>;

    template <class Row, class Value>
    static void keep(Puts& given, const Row& row, std::size_t place, const Value& value) {
        given[place] = [row, value](Record& record) {
            auto* const target = row.find(record);
            if constexpr (requires { row.choice; }) {
                const std::string choice_flag = "--" + option_name_of(row.choice_name);
                if (target == nullptr)
                    throw InvalidInput("--" + option_name(row) + " needs " + choice_flag + " " +
                                       std::string(row.alternative) + ", but " + choice_flag + " is " +
                                       std::string(name_of(record.*row.choice)));
            }
            if constexpr (is_variant<Value>) {
                // An alternative that is chosen already keeps its parameters.
                if (target->index() == value.index()) return;
            }
            *target = value;
        };
    }

    /// The value in force where the flag is not given.
    template <class Row>
    static auto standard(const Row& row, const Record& defaults) {
        using Type = typename Row::Type;
        if (row.in_force != nullptr) return row.in_force(defaults);
        if constexpr (!std::same_as<Type, Held<Type>>)
            return Held<Type>{};
        else if constexpr (requires { row.choice; })
            return row.standard();
        else
            return *row.find(defaults);
    }

    /// The number as CLI11 shows the defaults of other numbers.
    template <class Number>
    static std::string text_of(const Number& number) {
        std::ostringstream out;
        out << number;
        return out.str();
    }

    std::shared_ptr<Puts> given_ = std::make_shared<Puts>();  ///< shared with the flags, which may outlive this
};

}  // namespace meniscus::cli
