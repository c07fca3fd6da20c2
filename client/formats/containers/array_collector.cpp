#include "formats/containers/array_collector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {
namespace {

ElementType element_type_of(ScalarType type) {
    switch (type) {
        case ScalarType::float32:
        case ScalarType::float64:
            return ElementType::float32;
        case ScalarType::uint8:
            return ElementType::uint8;
        case ScalarType::uint16:
        case ScalarType::uint32:
        case ScalarType::uint64:
            return ElementType::uint32;
        case ScalarType::int8:
        case ScalarType::int16:
        case ScalarType::int32:
        case ScalarType::int64:
            return ElementType::int32;
    }
    return ElementType::float32;
}

std::string in_components(std::size_t components) {
    return std::to_string(components) + (components == 1 ? " component" : " components");
}

/// Numbers of one thing that lie in scalars of their own.
struct Group {
    std::string name;
    std::vector<std::string> members;
    std::optional<std::string> fourth{};
};

/// The group that a scalar of this name begins, if it begins one.
std::optional<Group> group_of(const NamedValues& first) {
    if (first.components != 1) return std::nullopt;
    if (first.name == "red" && first.type == ElementType::uint8)
        return Group{"color", {"red", "green", "blue"}, "alpha"};
    if (first.name == "vx") return Group{"velocity", {"vx", "vy", "vz"}};
    if (first.name == "u") return Group{"velocity", {"u", "v", "w"}};
    if (first.name == "nx") return Group{"normal", {"nx", "ny", "nz"}};
    if (!first.name.ends_with("_x") || first.name.size() < 3) return std::nullopt;
    const std::string name = first.name.substr(0, first.name.size() - 2);
    return Group{name, {name + "_x", name + "_y", name + "_z"}, name + "_w"};
}

/// One array whose components are these scalars.
NamedValues interleaved(const std::string& name, std::span<const NamedValues* const> members) {
    NamedValues out{name, members.front()->type, members.size(), {}};
    const std::size_t bytes = size_of(out.type);
    const std::size_t count = members.front()->count();
    out.data.resize(count * out.element_bytes());
    for (std::size_t m = 0; m < members.size(); ++m)
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(out.data.data() + (i * members.size() + m) * bytes, members[m]->data.data() + i * bytes, bytes);
    return out;
}

void put_together(std::vector<NamedValues>& arrays) {
    std::unordered_map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < arrays.size(); ++i) places.emplace(arrays[i].name, i);
    std::vector<bool> gone(arrays.size(), false);
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const auto group = gone[i] ? std::nullopt : group_of(arrays[i]);
        if (!group || places.contains(group->name)) continue;
        const auto member = [&](const std::string& name) -> std::optional<std::size_t> {
            const auto place = places.find(name);
            if (place == places.end() || gone[place->second]) return std::nullopt;
            const NamedValues& array = arrays[place->second];
            if (array.components != 1 || array.type != arrays[i].type || array.data.size() != arrays[i].data.size())
                return std::nullopt;
            return place->second;
        };
        std::vector<std::size_t> found;
        for (const std::string& name : group->members)
            if (const auto place = member(name)) found.push_back(*place);
        if (found.size() < group->members.size()) continue;
        if (group->fourth)
            if (const auto place = member(*group->fourth)) found.push_back(*place);
        if (!can_be_attribute(arrays[i].type, found.size())) continue;
        std::vector<const NamedValues*> members;
        members.reserve(found.size());
        for (const std::size_t place : found) members.push_back(&arrays[place]);
        NamedValues whole = interleaved(group->name, members);
        for (const std::size_t place : found) {
            gone[place] = true;
            arrays[place].data = {};
        }
        gone[i] = false;
        arrays[i] = std::move(whole);
        places.emplace(group->name, i);
    }
    std::vector<NamedValues> rest;
    for (std::size_t i = 0; i < arrays.size(); ++i)
        if (!gone[i]) rest.push_back(std::move(arrays[i]));
    arrays = std::move(rest);
}

bool is_reserved(std::string_view name) {
    return name == "position" || name == "level";
}

}  // namespace

std::string array_name(std::string_view name) {
    std::string out;
    for (const char c : name.substr(0, max_array_name_bytes)) {
        if (c >= 'A' && c <= 'Z')
            out += static_cast<char>(c - 'A' + 'a');
        else
            out += (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : '_';
    }
    return out.empty() ? "_" : out;
}

ArrayBuilder::ArrayBuilder(std::string_view name, ScalarType type, std::size_t components, std::size_t count)
    : values_{array_name(name), element_type_of(type), components, {}}, type_(type) {
    if (values_.name != name) values_.label = name;
    if (!can_be_attribute(values_.type, components))
        reason_ = in_components(components) + " of " + std::string(meniscus::name_of(values_.type));
    else
        values_.data.resize(count * values_.element_bytes());
}

void ArrayBuilder::add(double value) {
    if (!wanted()) return;
    if (values_.type == ElementType::float32) {
        if (std::isfinite(value) && std::abs(value) > double{std::numeric_limits<float>::max()}) {
            reason_ = "a value is beyond float32";
            return;
        }
        const auto narrow = static_cast<float>(value);
        std::memcpy(values_.data.data() + position_, &narrow, sizeof narrow);
        position_ += sizeof narrow;
        return;
    }
    add_integer(value);
}

void ArrayBuilder::add_integer(double value) {
    const double most = values_.type == ElementType::uint8 ? 255.0 : double{std::numeric_limits<std::uint32_t>::max()};
    const double least = values_.type == ElementType::int32 ? double{std::numeric_limits<std::int32_t>::min()} : 0.0;
    if (!(value >= least && value <= most) || value != std::floor(value)) {
        reason_ = "a value that " + std::string(meniscus::name_of(values_.type)) + " does not hold";
        return;
    }
    if (values_.type == ElementType::uint8) {
        values_.data[position_++] = static_cast<std::byte>(value);
        return;
    }
    negative_ = negative_ || value < 0.0;
    above_int32_ = above_int32_ || value > double{std::numeric_limits<std::int32_t>::max()};
    const auto bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
    std::memcpy(values_.data.data() + position_, &bits, sizeof bits);
    position_ += sizeof bits;
}

void ArrayBuilder::finish() {
    if (values_.type != ElementType::int32 || !above_int32_) return;
    if (negative_ || type_ != ScalarType::int64)
        reason_ = "values that int32 does not hold";
    else
        values_.type = ElementType::uint32;
}

void ArrayCollector::add(ArrayBuilder array) {
    array.finish();
    if (!array.wanted()) return leave_out(array.values_.name, array.reason_);
    expect_room();
    arrays_.push_back(std::move(array.values_));
}

void ArrayCollector::expect_room() const {
    if (arrays_.size() + left_out_.size() == most_arrays)
        at_.fail("has more than " + std::to_string(most_arrays) + " arrays");
}

void ArrayCollector::leave_out(std::string_view name, std::string_view reason) {
    expect_room();
    left_out_.push_back(array_name(name) + " (" + std::string(reason) + ")");
}

void ArrayCollector::finish(std::vector<NamedValues>& arrays, std::vector<std::string>& left_out) {
    std::vector<NamedValues> gathered = std::exchange(arrays_, {});
    put_together(gathered);
    std::unordered_set<std::string> taken;
    for (NamedValues& array : gathered) {
        if (is_reserved(array.name))
            leave_out(array.name, "a name with another meaning");
        else if (taken.contains(array.name))
            leave_out(array.name, "the name of another array");
        else if (arrays.size() == max_particle_arrays)
            leave_out(array.name, "after the first " + std::to_string(max_particle_arrays));
        else {
            taken.insert(array.name);
            arrays.push_back(std::move(array));
        }
    }
    left_out = std::exchange(left_out_, {});
}

std::string described(const std::vector<NamedValues>& arrays, const std::vector<std::string>& left_out) {
    constexpr std::size_t most_listed = 32;
    std::string out = arrays.empty() ? "has no arrays" : "has ";
    for (const NamedValues& array : arrays) {
        if (&array != &arrays.front()) out += ", ";
        out += array.name + " (" + (array.components > 1 ? std::to_string(array.components) + " " : "") +
               std::string(meniscus::name_of(array.type)) + ")";
    }
    for (std::size_t i = 0; i < std::min(left_out.size(), most_listed); ++i)
        out += (i == 0 ? "; left out: " : ", ") + left_out[i];
    if (left_out.size() > most_listed) out += ", and " + std::to_string(left_out.size() - most_listed) + " more";
    return out;
}

}  // namespace meniscus::formats
