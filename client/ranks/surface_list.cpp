#include "ranks/surface_list.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include "formats/bytes/atomic_file.hpp"
#include "formats/meshes/pvd_writer.hpp"
#include "meniscus/error.hpp"
#include "meniscus/number_text.hpp"

namespace meniscus::ranks {
namespace {

constexpr int least_share = 20;  ///< of the time, for each part of it that the list takes
constexpr std::size_t frame_digits = 6;

std::filesystem::path list_of(const std::filesystem::path& folder) {
    return folder / "surface.pvd";
}

std::string padded(std::uint64_t number, std::size_t digits) {
    const std::string text = std::to_string(number);
    return std::string(digits - std::min(digits, text.size()), '0') + text;
}

/// A list without frames.
std::string beginning_of(std::uint64_t run) {
    return std::string(formats::pvd_begin)
        .append("    <!-- run " + std::to_string(run) + " has no frames yet -->\n")
        .append(formats::pvd_end);
}

/// Writes a file that was not there. Throws InvalidInput.
void make_file(const std::filesystem::path& path, const std::string& text) {
    const auto fail = [&path] {
        throw InvalidInput(path.string() + ": cannot be written: " + std::generic_category().message(errno));
    };
    std::FILE* const file = std::fopen(path.c_str(), "wxe");
    if (file == nullptr && errno == EEXIST)
        throw InvalidInput(path.string() +
                           " is there: name a folder without one, or move away what another run has written");
    if (file == nullptr) fail();
    std::fputs(text.c_str(), file);
    if (std::fclose(file) == 0) return;  // which writes it
    const int error = errno;
    std::filesystem::remove(path);
    errno = error;
    fail();
}

}  // namespace

std::string surface_name(std::uint64_t frame, std::size_t part, std::size_t parts) {
    const std::size_t digits = std::to_string(parts - 1).size();
    return "surface-" + padded(frame, frame_digits) + "-part-" + padded(part, digits) + ".vtp";
}

SurfaceList::SurfaceList(std::filesystem::path folder, std::uint64_t run) : folder_(std::move(folder)) {
    formats::make_directory(folder_);
    make_file(list_of(folder_), beginning_of(run));
}

SurfaceList::~SurfaceList() {
    try {
        if (written_ != whole_) write();
        if (whole_ == 0) std::filesystem::remove(list_of(folder_));
    } catch (const std::exception&) {
        // Of files that could not be written the last push has told.
    }
}

bool SurfaceList::is_in(const std::filesystem::path& folder, std::uint64_t run) {
    std::ifstream list(list_of(folder), std::ios::binary);
    const std::string expected = beginning_of(run);
    std::string text(expected.size(), '\0');
    list.read(text.data(), static_cast<std::streamsize>(text.size()));
    return list && text == expected;
}

void SurfaceList::add(const Frame& frame) {
    frames_.push_back(frame);
}

void SurfaceList::write_in_time() {
    if (written_ != whole_ && Clock::now() >= next_) write();
}

void SurfaceList::write() {
    const Clock::time_point begin = Clock::now();
    const std::span<const Frame> whole(frames_.data(), whole_);
    const bool times_increase = std::ranges::adjacent_find(whole, [](const Frame& a, const Frame& b) {
                                    return a.simulation_time >= b.simulation_time;
                                }) == whole.end();
    try {
        formats::PvdWriter list(list_of(folder_));
        for (const Frame& frame : whole) {
            std::string time;
            times_increase ? append_shortest(time, frame.simulation_time) : append_shortest(time, frame.index);
            for (std::size_t part = 0; part < frame.parts; ++part)
                list.add(time, part, surface_name(frame.index, part, frame.parts));
        }
        list.commit();
    } catch (const InvalidInput& error) {
        throw ProcessFailed(error.what());  // no argument of a caller is wrong
    }
    written_ = whole_;
    next_ = Clock::now() + (least_share - 1) * (Clock::now() - begin);
}

}  // namespace meniscus::ranks
