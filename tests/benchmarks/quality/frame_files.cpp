#include "quality/frame_files.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "formats/particles/particle_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::benchmarks::quality {
namespace {

constexpr std::string_view prefix = "frame_";

std::optional<unsigned> to_number(std::string_view text) {
    unsigned number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

bool matches(unsigned number, const std::string& wanted) {
    if (wanted == "even") return number % 2 == 0;
    if (wanted == "odd") return number % 2 == 1;
    const std::optional<unsigned> one = to_number(wanted);
    if (!one) throw InvalidInput("--frames is " + wanted + ", but must be of numbers, even, odd");
    return number == *one;
}

}  // namespace

FrameFiles::FrameFiles(std::filesystem::path folder) {
    if (folder.empty()) {
        const char* named = std::getenv("MENISCUS_DATA");
        if (named == nullptr) return;
        folder = named;
    }
    if (!std::filesystem::is_directory(folder)) throw InvalidInput("--data is " + folder.string() + ", but no folder");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string stem = entry.path().stem().string();
        if (entry.path().extension() != ".vtk" || !stem.starts_with(prefix)) continue;
        if (const auto number = to_number(std::string_view(stem).substr(prefix.size())))
            files_.emplace_back(*number, entry.path());
    }
    std::sort(files_.begin(), files_.end());
}

std::vector<unsigned> FrameFiles::choose(const std::vector<std::string>& wanted) const {
    std::vector<unsigned> numbers;
    for (const auto& [number, path] : files_)
        if (std::any_of(wanted.begin(), wanted.end(), [n = number](const std::string& w) { return matches(n, w); }))
            numbers.push_back(number);
    return numbers;
}

bool FrameFiles::has(unsigned number) const {
    return std::any_of(files_.begin(), files_.end(), [&](const auto& file) { return file.first == number; });
}

Cloud FrameFiles::read(unsigned number) const {
    const auto found =
        std::find_if(files_.begin(), files_.end(), [&](const auto& file) { return file.first == number; });
    if (found == files_.end()) throw InvalidInput("there is no frame " + std::to_string(number));
    Cloud cloud;
    cloud.name = found->second.stem().string();
    cloud.positions = formats::read_particles(found->second).positions;
    return cloud;
}

}  // namespace meniscus::benchmarks::quality
