// A described record (meniscus/described.hpp) as JSON, by the names of its rows.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <type_traits>

#include "meniscus/described.hpp"
#include "meniscus/names.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::cli {

template <class Record>
nlohmann::ordered_json rows_json(const Record& record);

template <class Value>
nlohmann::ordered_json value_json(const Value& value, const Facts& facts) {
    if constexpr (std::is_enum_v<Value> || is_variant<Value>) {
        return name_of(value);
    } else if constexpr (std::is_same_v<Value, Box>) {
        return {{"min", value.min}, {"max", value.max}};
    } else if constexpr (Described<Value>) {
        return rows_json(value);
    } else if constexpr (is_list<Value>) {
        auto out = nlohmann::ordered_json::array();
        for (const auto& element : value) out.push_back(value_json(element, facts));
        return out;
    } else if constexpr (requires { std::tuple_size<Value>::value; }) {
        nlohmann::ordered_json out;
        for (std::size_t i = 0; i < value.size(); ++i) out[std::string(facts.entries[i])] = value[i];
        return out;
    } else {
        return value;
    }
}

/// Every row that is not shown by hand, in the order of the rows. A parameter of a choice that was not made, and a
/// value that is missing, have what is in force without them; what has nothing in force is left out.
template <class Record>
nlohmann::ordered_json rows_json(const Record& record) {
    auto out = nlohmann::ordered_json::object();
    for_each_row<Record>([&]<class Row>(const Row& row) {
        if (row.facts.by_hand) return;
        const std::string name = flat_name(row);
        const auto* const value = row.find(record);
        if constexpr (requires { value->has_value(); }) {
            if (row.in_force != nullptr)
                out[name] = value_json(row.in_force(record), row.facts);
            else if (value != nullptr && *value)
                out[name] = value_json(**value, row.facts);
        } else if constexpr (requires { row.choice; }) {
            out[name] = value_json(value == nullptr ? row.standard() : *value, row.facts);
        } else {
            out[name] = value_json(*value, row.facts);
        }
    });
    return out;
}

}  // namespace meniscus::cli
