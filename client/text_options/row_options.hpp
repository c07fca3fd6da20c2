// A described record (meniscus/described.hpp) from options by the names of its rows.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "meniscus/described.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::text_options {

template <class Value>
void read_value(OptionReader& options, const std::string& option, const Facts& facts, Value& value) {
    if constexpr (is_variant<Value>) {
        // An alternative that was chosen already keeps its parameters.
        Value given = value;
        options.read_choice(option, given);
        if (given.index() != value.index()) value = given;
    } else if constexpr (std::is_enum_v<Held<Value>>) {
        Held<Value> given{};
        options.read_choice(option, given);
        value = given;
    } else if constexpr (std::same_as<Value, int>) {
        // The wire's numbers have no signs: a server would tell of another one.
        std::optional<std::uint32_t> given;
        if (facts.range.least >= 0.0)
            options.read(option, given);
        else
            options.read(option, value);
        if (given) value = static_cast<int>(*given);
    } else {
        options.read(option, value);
    }
}

/// Reads the options of all rows that are not shown by hand; those of a member that is a record itself as its own. A
/// parameter of an alternative that was not chosen is refused, since it would change nothing.
template <class Record>
void read_rows(OptionReader& options, Record& record) {
    for_each_row<Record>([&]<class Row>(const Row& row) {
        using Value = typename Row::Type;
        if constexpr (Described<Value>) {
            read_rows(options, *row.find(record));
        } else if constexpr (!is_list<Value>) {
            if (row.facts.by_hand) return;
            const std::string option = option_name(row);
            const std::string* const text = options.find(option);
            if (text == nullptr) return;
            auto* const value = row.find(record);
            if constexpr (requires { row.choice; }) {
                if (value == nullptr)
                    throw InvalidInput(options.quoted(option) + " is " + quoted(*text) + ", but '" +
                                       options.naming()(option_name_of(row.choice_name)) + "' is " +
                                       std::string(name_of(record.*row.choice)) + ": set it to " +
                                       std::string(row.alternative) + ", or leave the option out");
            }
            read_value(options, option, row.facts, *value);
        }
    });
}

/// The record's defaults, and the options over them.
template <class Record>
Record record_of(OptionReader& options) {
    Record record;
    read_rows(options, record);
    return record;
}

}  // namespace meniscus::text_options
