#include "cli/print/warnings.hpp"

#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "formats/particles/particles.hpp"

namespace meniscus::cli {

void add_strict_option(CLI::App& command, bool& strict) {
    command.add_flag("--strict", strict, "Exit code 3 where there were warnings; all output is written all the same");
}

FileWarning faces_as_particles(std::size_t faces, std::size_t particles) {
    return {"faces_as_particles", static_cast<double>(faces), 0.0, formats::corners_as_particles(faces, particles)};
}

FileWarning no_particles(std::size_t in_file) {
    std::string why = "the file has no particles";
    if (in_file != 0)
        why = (in_file == 1 ? std::string("the one particle of the file lies")
                            : "all " + std::to_string(in_file) + " particles of the file lie") +
              " outside --particle-aabb";
    return {"no_particles", static_cast<double>(in_file), 0.0, "the surface is empty: " + why};
}

FileWarning positions_rounded(double moved, double limit, const std::array<double, 3>& middle) {
    std::ostringstream text;
    text << "rounding its float64 positions to float32 moves them by up to " << moved << ", more than " << limit
         << ", a hundredth of the particle radius: --origin " << std::setprecision(17) << middle[0] << ' ' << middle[1]
         << ' ' << middle[2] << " keeps them";
    return {"positions_rounded", moved, limit, text.str()};
}

void Warnings::say(const std::string& where, std::span<const Warning> warnings) {
    for (const Warning& warning : warnings) say(where, warning.text);
}

void Warnings::say(const std::string& where, const FileWarning& warning) {
    say(where, warning.text);
}

void Warnings::say(const std::string& where, const std::string& text) {
    any_ = true;
    std::cerr << "meniscus: warning: " << where << ": " << text << '\n';
}

void Warnings::finish() const {
    if (strict_ && any_) throw Warned();
}

}  // namespace meniscus::cli
