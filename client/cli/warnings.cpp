#include "cli/warnings.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

namespace meniscus::cli {

void add_strict_option(CLI::App& command, bool& strict) {
    command.add_flag("--strict", strict, "Exit code 3 where there were warnings; all output is written all the same");
}

std::string FileWarning::text() const {
    return "the file has " + std::to_string(faces) + " faces, so that it is a mesh: its " + std::to_string(particles) +
           " corners are taken as particles";
}

void Warnings::say(const std::string& where, std::span<const Warning> warnings) {
    for (const Warning& warning : warnings) say(where, warning.text);
}

void Warnings::say(const std::string& where, const FileWarning& warning) {
    say(where, warning.text());
}

void Warnings::say(const std::string& where, const std::string& text) {
    any_ = true;
    std::cerr << "meniscus: warning: " << where << ": " << text << '\n';
}

void Warnings::finish() const {
    if (strict_ && any_) throw Warned();
}

}  // namespace meniscus::cli
