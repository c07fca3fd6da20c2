#include "lab_options.hpp"

#include <charconv>
#include <span>
#include <string>
#include <string_view>

#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::benchmarks {
namespace {

using Words = std::span<const char* const>;

/// The words that belong to a flag: those up to the next one, at least one. Takes them from `rest`.
Words values_of(std::string_view flag, Words& rest) {
    std::size_t count = 0;
    while (count < rest.size() && !std::string_view(rest[count]).starts_with("--")) ++count;
    if (count == 0) throw InvalidInput(std::string(flag) + " needs a value");
    const Words values = rest.first(count);
    rest = rest.subspan(count);
    return values;
}

template <class Number>
Number number(std::string_view flag, std::string_view word, Number least) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < least)
        throw InvalidInput(std::string(flag) + " is '" + std::string(word) + "', must be a number, " +
                           std::to_string(least) + " or more");
    return value;
}

template <class T, class Read>
std::vector<T> list(Words words, Read read) {
    std::vector<T> out;
    for (const char* word : words) out.push_back(read(word));
    return out;
}

template <class Enumeration>
std::vector<Enumeration> names_in(Words words, const char* what) {
    return list<Enumeration>(words, [what](const char* word) { return by_name<Enumeration>(word, what); });
}

}  // namespace

LabOptions read_lab_options(int argc, const char* const* argv) {
    LabOptions options;
    Words rest(argv + 1, static_cast<std::size_t>(argc - 1));
    while (!rest.empty()) {
        const std::string_view flag = rest[0];
        rest = rest.subspan(1);
        if (flag == "--no-compare")
            options.compare = false;
        else if (flag == "--kernels")
            options.kernels = true;
        else if (flag == "--particles")
            options.particles = list<std::size_t>(
                values_of(flag, rest), [&](const char* word) { return number(flag, word, basin_particles); });
        else if (flag == "--cell-sizes")
            options.cell_sizes =
                list<double>(values_of(flag, rest), [&](const char* word) { return number(flag, word, 0.1); });
        else if (flag == "--fields")
            options.fields = names_in<Field>(values_of(flag, rest), "field");
        else if (flag == "--modes")
            options.modes = names_in<Mode>(values_of(flag, rest), "mode");
        else if (flag == "--waters")
            options.waters = names_in<WaterKind>(values_of(flag, rest), "water");
        else if (flag == "--backend")
            options.backend = names_in<Backend>(values_of(flag, rest), "backend").back();
        else if (flag == "--runs")
            options.runs = number(flag, values_of(flag, rest).back(), 1U);
        else
            throw InvalidInput("'" + std::string(flag) + "' is not known; see kernel-lab --help");
    }
    return options;
}

const char* lab_help() {
    return "kernel-lab [--particles N...] [--cell-sizes C...] [--fields F...] [--modes M...] [--waters W...]\n"
           "           [--runs N] [--kernels] [--no-compare] [--backend cuda|cpu]\n"
           "Compares the mesh of the GPU with that of the CPU, byte by byte, and times its steps; --kernels: and its\n"
           "kernels. Exit codes: 0 all the same, 1 a mesh differs, 2 wrong arguments, 77 there is no GPU.\n";
}

}  // namespace meniscus::benchmarks
