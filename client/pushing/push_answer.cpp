#include "pushing/push_answer.hpp"

#include <concepts>
#include <string>
#include <system_error>
#include <type_traits>

#include "meniscus/client/errors.hpp"
#include "meniscus/described.hpp"
#include "meniscus/number_text.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::pushing {
namespace {

template <class Value>
void read(const JsonLine& line, const std::string& name, Value& value) {
    const auto found = line.find(name);
    if (found == line.end()) return;
    const std::string& text = found->second;
    if constexpr (std::is_same_v<Value, std::string>) {
        value = text;
    } else {
        if (text == "null") return;  // a number that is none
        const char* const end = text.data() + text.size();
        const auto result = read_number(text.data(), end, value);
        if (result.ec != std::errc() || result.ptr != end)
            throw client::ServerError("meniscus push answers " + quoted(text) + " for " + name +
                                      ", which is no number");
    }
}

/// The rows that are numbers or texts, and the elements of those that have names for them.
template <class Record>
void read_rows(const JsonLine& line, Record& record) {
    for_each_row<Record>([&]<class Row>(const Row& row) {
        using Value = typename Row::Type;
        const std::string name = flat_name(row);
        if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
            read(line, name, *row.find(record));
        } else if constexpr (requires { std::tuple_size<Value>::value; }) {
            for (std::size_t i = 0; i < row.facts.entries.size(); ++i)
                read(line, name + "." + std::string(row.facts.entries[i]), (*row.find(record))[i]);
        }
    });
}

}  // namespace

client::ReceivedFrame read_answer(const JsonLine& line) {
    if (line.find("frame") == line.end())
        throw client::ServerError("what meniscus push answers has no number of a frame");
    client::ReceivedFrame answer;
    read(line, "frame", answer.index);
    read(line, "simulation_time", answer.simulation_time);
    read_rows<Statistics>(line, answer.statistics);
    read_rows(line, answer.statistics);
    return answer;
}

}  // namespace meniscus::pushing
