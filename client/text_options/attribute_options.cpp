#include "text_options/attribute_options.hpp"

#include <string>
#include <string_view>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::text_options {
namespace {

constexpr std::string_view all = "all";

/// Of the option "attribute", with spaces between them.
std::vector<std::string> names_of(OptionReader& options) {
    std::vector<std::string> names;
    const std::string* const text = options.find("attribute");
    if (text == nullptr) return names;
    for (std::size_t first = text->find_first_not_of(' '); first != std::string::npos;) {
        const std::size_t end = text->find(' ', first);
        names.push_back(text->substr(first, end - first));
        first = text->find_first_not_of(' ', end);
    }
    if (names.size() > 1)
        for (const std::string& name : names)
            if (name == all)
                throw InvalidInput(options.quoted("attribute") + " is " + quoted(*text) +
                                   ", must be names, or all alone");
    return names;
}

/// "velocity", or "velocity:12" with bits of its own.
AttributeWish wish_of(const std::string& text, int bits, OptionNaming naming) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return {.name = text, .bits = bits};
    const std::string own = text.substr(colon + 1);
    const Options options{{"attribute-bits", own}};
    OptionReader reader(&options, naming);
    return {.name = text.substr(0, colon), .bits = read_attribute_bits(reader)};
}

/// Empty names stand for all.
std::vector<AttributeWish> every_attribute(int bits) {
    return {{.name = {}, .bits = bits}};
}

}  // namespace

void read_attributes(OptionReader& options, Settings& settings) {
    settings.attributes = names_of(options);
    settings.all_attributes = settings.attributes == std::vector{std::string(all)};
    if (settings.all_attributes) settings.attributes.clear();
}

int read_attribute_bits(OptionReader& options) {
    int bits = default_attribute_bits;
    options.read("attribute-bits", bits);
    if (bits < 0 || bits > max_attribute_bits)
        throw InvalidInput(options.quoted("attribute-bits") + " is '" + std::to_string(bits) + "', must be 1 to " +
                           std::to_string(max_attribute_bits) + ", or 0 for exact values");
    return bits;
}

std::vector<AttributeWish> read_attribute_wishes(OptionReader& options) {
    const std::vector<std::string> names = names_of(options);
    const int bits = read_attribute_bits(options);
    if (names == std::vector{std::string(all)}) return every_attribute(bits);
    std::vector<AttributeWish> wishes;
    wishes.reserve(names.size());
    for (const std::string& name : names) wishes.push_back(wish_of(name, bits, options.naming()));
    return wishes;
}

std::vector<AttributeWish> read_every_attribute(OptionReader& options) {
    return every_attribute(read_attribute_bits(options));
}

}  // namespace meniscus::text_options
