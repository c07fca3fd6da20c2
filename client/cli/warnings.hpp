// Warnings on stderr, one line each, and the exit code that --strict makes of them.
#pragma once

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

/// What the reader of a particle file finds, which is no frame's.
struct FileWarning {
    static constexpr std::string_view code = "faces_as_particles";
    std::size_t faces = 0;      ///< of the file
    std::size_t particles = 0;  ///< that their corners were taken for
    std::string text() const;
};

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
