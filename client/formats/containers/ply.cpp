#include "formats/containers/ply.hpp"

#include <array>
#include <utility>

namespace meniscus::formats {
namespace {

/// Memory of an element or a property, with what its readers keep of it.
constexpr std::size_t header_line_bytes = 256;

ScalarType type_by_name(std::string_view name, const ByteCursor& at) {
    using T = ScalarType;
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 16> types{{
        {"char", T::int8},
        {"int8", T::int8},
        {"uchar", T::uint8},
        {"uint8", T::uint8},
        {"short", T::int16},
        {"int16", T::int16},
        {"ushort", T::uint16},
        {"uint16", T::uint16},
        {"int", T::int32},
        {"int32", T::int32},
        {"uint", T::uint32},
        {"uint32", T::uint32},
        {"float", T::float32},
        {"float32", T::float32},
        {"double", T::float64},
        {"float64", T::float64},
    }};
    for (const auto& [key, type] : types)
        if (key == name) return type;
    at.fail(quoted(name) + " is no type of a PLY file");
}

PlyProperty parse_property(ByteCursor& words) {
    PlyProperty property;
    std::string_view type = words.word();
    if (type == "list") {
        property.list_count_type = type_by_name(words.word(), words);
        if (!is_integer(*property.list_count_type)) words.fail("a list with a count that is no integer");
        type = words.word();
    }
    property.type = type_by_name(type, words);
    property.name = words.word();
    return property;
}

}  // namespace

std::optional<std::size_t> PlyElement::scalar(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == property && !properties[i].list_count_type) return i;
    return std::nullopt;
}

std::optional<std::size_t> PlyElement::list(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == property && properties[i].list_count_type) return i;
    return std::nullopt;
}

PlyReader::PlyReader(const std::string& name, std::string_view bytes, const ReadLimits& limits)
    : in_(name, bytes), budget_(limits, bytes.size(), in_) {
    if (!bytes.starts_with("ply\n") && !bytes.starts_with("ply\r\n"))
        in_.fail("not a PLY file: it does not begin with 'ply'");
    in_.line();
    bool has_format = false;
    while (true) {
        const std::string_view text = in_.line();
        if (text == "end_header") break;
        ByteCursor words(name, text);
        const std::string_view keyword = words.skip_space() ? words.word() : "comment";
        if (keyword == "comment" || keyword == "obj_info") continue;
        if (keyword == "format") {
            const std::string_view format = words.word();
            if (format == "binary_little_endian")
                binary_ = std::endian::little;
            else if (format == "binary_big_endian")
                binary_ = std::endian::big;
            else if (format != "ascii")
                in_.fail("PLY format " + quoted(format) + " is not known");
            has_format = true;
        } else if (keyword == "element") {
            budget_.take(header_line_bytes, in_, "its header");
            PlyElement element;
            element.name = words.word();
            element.count = words.count("number of elements");
            elements_.push_back(std::move(element));
        } else if (keyword == "property") {
            if (elements_.empty()) in_.fail("a property before the first element");
            budget_.take(header_line_bytes, in_, "its header");
            elements_.back().properties.push_back(parse_property(words));
        } else {
            in_.fail(quoted(keyword) + " is no keyword of a PLY header");
        }
    }
    if (!has_format) in_.fail("a PLY header without format");
}

void PlyReader::expect_rows(const PlyElement& element) const {
    std::size_t bytes = 0;
    for (const PlyProperty& p : element.properties) bytes += binary_ ? size_of(p.list_count_type.value_or(p.type)) : 2;
    if (bytes == 0) {
        if (element.count > 0) in_.fail("element " + quoted(element.name) + " has no properties");
        return;
    }
    // In ascii the last number of the file needs no separator after it.
    in_.expect(binary_ ? element.count : element.count / 2, bytes, element.name + " rows");
}

void PlyReader::read_rows(const PlyElement& element, const std::function<void(std::size_t, const PlyRow&)>& row) {
    expect_rows(element);
    PlyRow values;
    values.scalars.resize(element.properties.size());
    values.lists.resize(element.properties.size());
    for (std::size_t i = 0; i < element.count; ++i) {
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (!property.list_count_type) {
                values.scalars[p] = next(property.type);
                continue;
            }
            const double count = next(*property.list_count_type);
            if (!(count >= 0.0 && count <= static_cast<double>(in_.remaining())))
                in_.fail("truncated: a list of " + std::to_string(count) + " items, but only " +
                         std::to_string(in_.remaining()) + " bytes follow");
            const auto items = static_cast<std::size_t>(count);
            in_.expect(binary_ ? items : items / 2, binary_ ? size_of(property.type) : 2, "list items");
            if (items > values.lists[p].capacity()) budget_.take(sizeof(double) * items, in_, "a list");
            values.lists[p].resize(items);
            for (double& item : values.lists[p]) item = next(property.type);
        }
        row(i, values);
    }
}

void PlyReader::expect_end() {
    if (binary_ ? in_.remaining() > 0 : in_.skip_space())
        in_.fail(std::to_string(in_.remaining()) + " bytes follow the last announced element");
}

double PlyReader::next(ScalarType type) {
    if (!binary_) return in_.number("value");
    return load_scalar(type, in_.take(size_of(type)).data(), *binary_);
}

}  // namespace meniscus::formats
