#include "node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

namespace meniscus::catalyst {
namespace {

NumberType type_of(const conduit_datatype* type) {
    using Is = int (*)(const conduit_datatype*);
    constexpr std::array<std::pair<Is, NumberType>, 10> types{{
        {catalyst_conduit_datatype_is_int8, NumberType::int8},
        {catalyst_conduit_datatype_is_int16, NumberType::int16},
        {catalyst_conduit_datatype_is_int32, NumberType::int32},
        {catalyst_conduit_datatype_is_int64, NumberType::int64},
        {catalyst_conduit_datatype_is_uint8, NumberType::uint8},
        {catalyst_conduit_datatype_is_uint16, NumberType::uint16},
        {catalyst_conduit_datatype_is_uint32, NumberType::uint32},
        {catalyst_conduit_datatype_is_uint64, NumberType::uint64},
        {catalyst_conduit_datatype_is_float32, NumberType::float32},
        {catalyst_conduit_datatype_is_float64, NumberType::float64},
    }};
    for (const auto& [is, number] : types)
        if (is(type) != 0)
            return catalyst_conduit_datatype_endianness_matches_machine(type) != 0 ? number : NumberType::other;
    return NumberType::other;
}

template <class Number>
Number read(const std::byte* place) {
    Number number;
    std::memcpy(&number, place, sizeof number);
    return number;
}

}  // namespace

Node Node::at(const std::string& path) const {
    if (node_ == nullptr || catalyst_conduit_node_has_path(node_, path.c_str()) == 0) return Node(nullptr);
    return Node(catalyst_conduit_node_fetch_existing(node_, path.c_str()));
}

std::vector<Node> Node::children() const {
    std::vector<Node> found;
    const conduit_index_t count = node_ == nullptr ? 0 : catalyst_conduit_node_number_of_children(node_);
    for (conduit_index_t i = 0; i < count; ++i) found.emplace_back(catalyst_conduit_node_child(node_, i));
    return found;
}

std::string Node::name() const {
    const std::unique_ptr<char, void (*)(void*)> name(catalyst_conduit_node_name(node_), std::free);
    return name == nullptr ? std::string() : std::string(name.get());
}

std::optional<std::string> Node::text() const {
    if (node_ == nullptr || catalyst_conduit_datatype_is_char8_str(catalyst_conduit_node_dtype(node_)) == 0)
        return std::nullopt;
    const char* const text = catalyst_conduit_node_as_char8_str(node_);
    return text == nullptr ? std::string() : std::string(text);
}

Numbers Node::numbers() const {
    if (node_ == nullptr) return {};
    const conduit_datatype* const type = catalyst_conduit_node_dtype(node_);
    const conduit_index_t count = std::max<conduit_index_t>(catalyst_conduit_datatype_number_of_elements(type), 0);
    Numbers found{.count = static_cast<std::size_t>(count), .type = type_of(type)};
    if (found.type == NumberType::other || count == 0) return found;
    found.first = static_cast<const std::byte*>(catalyst_conduit_node_element_ptr(node_, 0));
    found.stride = catalyst_conduit_datatype_stride(type);
    return found;
}

std::optional<double> Node::number() const {
    const Numbers numbers = this->numbers();
    if (numbers.first == nullptr) return std::nullopt;
    if (numbers.type == NumberType::float32) return double{read<float>(numbers.first)};
    if (numbers.type == NumberType::float64) return read<double>(numbers.first);
    const auto whole = integer();
    return whole ? std::optional(static_cast<double>(*whole)) : std::nullopt;
}

std::optional<std::int64_t> Node::integer() const {
    const Numbers numbers = this->numbers();
    if (numbers.first == nullptr) return std::nullopt;
    switch (numbers.type) {
        case NumberType::int8:
            return read<std::int8_t>(numbers.first);
        case NumberType::int16:
            return read<std::int16_t>(numbers.first);
        case NumberType::int32:
            return read<std::int32_t>(numbers.first);
        case NumberType::int64:
            return read<std::int64_t>(numbers.first);
        case NumberType::uint8:
            return read<std::uint8_t>(numbers.first);
        case NumberType::uint16:
            return read<std::uint16_t>(numbers.first);
        case NumberType::uint32:
            return read<std::uint32_t>(numbers.first);
        case NumberType::uint64:
            if (const auto value = read<std::uint64_t>(numbers.first); std::in_range<std::int64_t>(value))
                return static_cast<std::int64_t>(value);
            return std::nullopt;
        case NumberType::float32:
        case NumberType::float64: {
            // A script's timestep, for example, that is a float without need.
            const double value = *number();
            constexpr double most = 0x1p53;
            return std::abs(value) <= most && value == std::trunc(value)
                       ? std::optional(static_cast<std::int64_t>(value))
                       : std::nullopt;
        }
        case NumberType::other:
            return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace meniscus::catalyst
