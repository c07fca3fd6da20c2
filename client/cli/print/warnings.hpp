// Warnings on stderr, one line each, and the exit code that --strict makes of them.
#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <string_view>

#include "meniscus/warning.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace meniscus::cli {

/// Thrown when all is done and written: there were warnings, and --strict.
class Warned : public std::exception {
public:
    const char* what() const noexcept override { return "there were warnings"; }
};

/// The flag --strict.
void add_strict_option(CLI::App& command, bool& strict);

/// A warning about a particle file, from before there is a frame.
struct FileWarning {
    std::string_view code;
    double value = 0.0;
    double limit = 0.0;
    std::string text;
};

/// The file is a mesh of `faces` faces; its corners were taken for particles.
FileWarning faces_as_particles(std::size_t faces, std::size_t particles);
/// in_file: number of the particles before those outside --particle-aabb were left out.
FileWarning no_particles(std::size_t in_file);
/// float32 has moved a particle by `moved`, world units. middle: an origin that keeps them.
FileWarning positions_rounded(double moved, double limit, const std::array<double, 3>& middle);

class Warnings {
public:
    explicit Warnings(bool strict) : strict_(strict) {}

    /// where: the frame or its file.
    void say(const std::string& where, std::span<const Warning> warnings);
    void say(const std::string& where, const FileWarning& warning);
    /// To be called once all is written. Throws Warned.
    void finish() const;

private:
    void say(const std::string& where, const std::string& text);

    bool strict_;
    bool any_ = false;
};

}  // namespace meniscus::cli
