// DualSPHysics' files, made by their layout: none of its own was at hand.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/bytes/scalar.hpp"

namespace meniscus::test {

/// Makes the pieces of one file. wide: sizes of arrays have 64 bits.
struct Bi4 {
    std::endian order = std::endian::little;
    bool wide = false;

    template <class T>
    std::string numbers(const std::vector<T>& values) const {
        std::string out;
        for (const T value : values) formats::store(out, value, order);
        return out;
    }
    std::string number(std::uint32_t value) const { return numbers<std::uint32_t>({value}); }
    std::string size(std::uint64_t value) const {
        return wide ? numbers<std::uint64_t>({value}) : number(static_cast<std::uint32_t>(value));
    }
    std::string text(const std::string& text) const { return number(static_cast<std::uint32_t>(text.size())) + text; }

    std::string header() const {
        std::string out = "#FileJBD JPartDataBi4";
        out.resize(58, ' ');
        out += std::string("\n\0", 2);
        out += static_cast<char>((order == std::endian::big ? 1 : 0) + (wide ? 10 : 0));
        out += static_cast<char>(wide ? 1 : 0);
        return out + std::string(2, '\0');
    }
    std::string value(const std::string& name, std::uint32_t type, const std::string& bytes) const {
        return text(name) + number(type) + bytes;
    }
    std::string array(const std::string& name, std::uint32_t type, std::uint64_t count,
                      const std::string& bytes) const {
        const std::string description =
            text("\nARRAY") + text(name) + number(0) + number(type) + size(count) + size(bytes.size());
        return number(static_cast<std::uint32_t>(description.size())) + description + bytes;
    }
    /// The others' numbers are those of the lists.
    std::string item(const std::string& name, const std::vector<std::string>& values,
                     const std::vector<std::string>& arrays, const std::vector<std::string>& items) const {
        std::string all_values = text("\nVALUES") + number(static_cast<std::uint32_t>(values.size()));
        for (const std::string& value : values) all_values += value;
        const std::string description = text("\nITEM\n") + text(name) + number(0) + number(0) + text("%.7E") +
                                        text("%.15E") + number(static_cast<std::uint32_t>(arrays.size())) +
                                        number(static_cast<std::uint32_t>(items.size())) +
                                        number(static_cast<std::uint32_t>(all_values.size()));
        std::string out = number(static_cast<std::uint32_t>(description.size())) + description + all_values;
        for (const std::string& array : arrays) out += array;
        for (const std::string& item : items) out += item;
        return out;
    }
    /// A case with `walls` particles of walls, and a step of it.
    std::string file(std::uint64_t walls, const std::vector<std::string>& arrays) const {
        const std::string step = item("PART_0007", {value("TimeStep", 12, numbers<double>({0.25}))}, arrays, {});
        return header() + item("JPartDataBi4",
                               {value("AppName", 1, text("DualSPHysics5")), value("Data2d", 2, number(0)),
                                value("CasePosMin", 23, numbers<double>({0, 0, 0})),
                                value("CaseNfixed", 10, numbers<std::uint64_t>({walls})),
                                value("CaseNmoving", 10, numbers<std::uint64_t>({0}))},
                               {}, {step});
    }
    /// A particle of a wall between two of the fluid.
    std::string sample() const {
        return file(5, {array("Idp", 8, 3, numbers<std::uint32_t>({9, 4, 5})),
                        array("Pos", 22, 3, numbers<float>({1, 2, 3, -1, -1, -1, 4, 5, 6})),
                        array("Vel", 22, 3, numbers<float>({10, 20, 30, 0, 0, 0, 40, 50, 60})),
                        array("Rhop", 11, 3, numbers<float>({1000, 1, 1001}))});
    }
};

}  // namespace meniscus::test
