// A described record (meniscus/described.hpp) as a dict, by the names of its rows.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <string>
#include <type_traits>

#include "meniscus/described.hpp"
#include "meniscus/names.hpp"
#include "meniscus/settings.hpp"
#include "text_out.hpp"

namespace meniscus::python {

template <Described Record>
pybind11::dict rows_dict(const Record& record);

template <class Value>
pybind11::object value_object(const Value& value, const Facts& facts) {
    if constexpr (std::is_enum_v<Value> || is_variant<Value>) {
        return pybind11::cast(name_of(value));
    } else if constexpr (std::is_same_v<Value, std::string>) {
        return text_out(value);
    } else if constexpr (std::is_same_v<Value, Box>) {
        const auto point = [](const auto& p) { return pybind11::make_tuple(p[0], p[1], p[2]); };
        return pybind11::make_tuple(point(value.min), point(value.max));
    } else if constexpr (Described<Value>) {
        return rows_dict(value);
    } else if constexpr (is_list<Value>) {
        pybind11::list out;
        for (const auto& element : value) out.append(value_object(element, facts));
        return out;
    } else if constexpr (requires { value.has_value(); }) {
        return value ? value_object(*value, facts) : pybind11::none();
    } else if constexpr (requires { value.size(); }) {
        pybind11::dict out;
        for (std::size_t i = 0; i < value.size(); ++i)
            out[pybind11::str(facts.entries[i].data(), facts.entries[i].size())] = value[i];
        return out;
    } else {
        return pybind11::cast(value);
    }
}

/// Every row that is not shown by hand, in the order of the rows. None for a value that is missing and a parameter of a
/// choice that was not made.
template <Described Record>
pybind11::dict rows_dict(const Record& record) {
    pybind11::dict out;
    for_each_row<Record>([&](const auto& row) {
        if (row.facts.by_hand) return;
        const auto* const value = row.find(record);
        const pybind11::str name(flat_name(row));
        out[name] = value == nullptr ? pybind11::none() : value_object(*value, row.facts);
    });
    return out;
}

}  // namespace meniscus::python
