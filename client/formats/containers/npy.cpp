#include "formats/containers/npy.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

namespace meniscus::formats {
namespace {

constexpr std::string_view magic{"\x93NUMPY", 6};

std::optional<ScalarType> npy_type(std::string_view name) {
    using T = ScalarType;
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 11> types{{
        {"f4", T::float32},
        {"f8", T::float64},
        {"i1", T::int8},
        {"i2", T::int16},
        {"i4", T::int32},
        {"i8", T::int64},
        {"u1", T::uint8},
        {"u2", T::uint16},
        {"u4", T::uint32},
        {"u8", T::uint64},
        {"b1", T::uint8},
    }};
    for (const auto& [key, type] : types)
        if (key == name) return type;
    return std::nullopt;
}

/// The header: a Python dictionary of a string (or a list, of structures), a truth value and a tuple.
class Header {
public:
    Header(const ByteCursor& at, std::string_view text) : at_(at), text_(text) {}

    /// Behind 'KEY':
    std::string_view after(std::string_view key) const {
        for (const char mark : {'\'', '"'}) {
            const std::string key_text = mark + std::string(key) + mark;
            const std::size_t place = text_.find(key_text);
            if (place == std::string_view::npos) continue;
            std::string_view rest = trimmed(text_.substr(place + key_text.size()));
            if (!rest.starts_with(':')) break;
            return trimmed(rest.substr(1));
        }
        at_.fail("an .npy header without " + quoted(key));
    }

    std::string_view string(std::string_view key) const {
        const std::string_view rest = after(key);
        if (rest.empty() || (rest[0] != '\'' && rest[0] != '"')) return {};
        const std::size_t end = rest.find(rest[0], 1);
        return end == std::string_view::npos ? std::string_view{} : rest.substr(1, end - 1);
    }

    std::vector<std::size_t> tuple(std::string_view key) const {
        std::string_view rest = after(key);
        if (!rest.starts_with('(')) at_.fail("an .npy header whose " + std::string(key) + " is no tuple");
        rest = trimmed(rest.substr(1));
        std::vector<std::size_t> out;
        while (!rest.starts_with(')')) {
            std::size_t value = 0;
            const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
            if (error != std::errc() || out.size() == most_dimensions)
                at_.fail("an .npy header whose " + std::string(key) + " has " + quoted(rest.substr(0, 20)) +
                         " where a size is expected");
            out.push_back(value);
            rest = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
            if (rest.starts_with(',')) rest = trimmed(rest.substr(1));
        }
        return out;
    }

private:
    static std::string_view trimmed(std::string_view text) {
        const std::size_t first = text.find_first_not_of(" \t\r\n");
        return first == std::string_view::npos ? std::string_view{} : text.substr(first);
    }

    const ByteCursor& at_;
    std::string_view text_;
};

}  // namespace

std::string shape_text(const std::vector<std::size_t>& shape) {
    constexpr std::size_t most_shown = 8;
    std::string out = "(";
    for (std::size_t i = 0; i < std::min(shape.size(), most_shown); ++i)
        out += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
    if (shape.size() > most_shown) out += ", ...";
    return out + (shape.size() == 1 ? ",)" : ")");
}

std::string_view npy_name_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "<f4";
        case ElementType::uint8:
            return "|u1";
        case ElementType::int32:
            return "<i4";
        case ElementType::uint32:
            return "<u4";
    }
    return {};
}

void set_npy_type(NpyArray& array, std::string_view name) {
    if (name.starts_with('>')) array.order = std::endian::big;
    if (!name.empty() && (name[0] == '<' || name[0] == '>' || name[0] == '|' || name[0] == '=')) name.remove_prefix(1);
    if (const auto type = npy_type(name))
        array.type = *type;
    else if (name.starts_with('O'))
        array.unread = "pickled Python objects";
    else
        array.unread = name.empty() ? "structures" : "numbers of type " + quoted(name);
}

NpyArray read_npy_array(const ByteCursor& at, std::string_view bytes) {
    ByteCursor in(at.name(), bytes);
    if (!bytes.starts_with(magic)) in.fail("no numpy array: it does not begin with '\\x93NUMPY'");
    in.take(magic.size());
    const auto major = static_cast<unsigned char>(in.take(2)[0]);
    if (major < 1 || major > 3) in.fail("version " + std::to_string(major) + " of .npy; 1 to 3 are read");
    const std::size_t length = major == 1 ? load<std::uint16_t>(in.take(2).data(), std::endian::little)
                                          : load<std::uint32_t>(in.take(4).data(), std::endian::little);
    const Header header(in, in.take(length));
    NpyArray array;
    array.shape = header.tuple("shape");
    array.fortran = header.after("fortran_order").starts_with("True");
    set_npy_type(array, header.string("descr"));
    if (!array.unread.empty()) {
        array.data = in.rest();
        return array;
    }
    std::size_t numbers = 1;
    for (const std::size_t size : array.shape)
        if (__builtin_mul_overflow(numbers, size, &numbers))
            in.fail("an array of shape " + shape_text(array.shape) + " is announced");
    in.expect(numbers, size_of(array.type), "numbers");
    array.data = in.take(numbers * size_of(array.type));
    if (in.remaining() > 0) in.fail(std::to_string(in.remaining()) + " bytes follow the array");
    return array;
}

std::string npy_header(std::string_view descr, const std::vector<std::size_t>& shape) {
    constexpr std::size_t alignment = 64;
    std::string text =
        "{'descr': '" + std::string(descr) + "', 'fortran_order': False, 'shape': " + shape_text(shape) + ", }";
    const std::size_t before = magic.size() + 4;
    text.append(alignment - 1 - (before + text.size()) % alignment, ' ');
    text += '\n';
    std::string out(magic);
    out += '\1';
    out += '\0';
    store(out, static_cast<std::uint16_t>(text.size()));
    return out + text;
}

}  // namespace meniscus::formats
