#include "ranks/surface_list.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "formats/bytes/atomic_file.hpp"
#include "formats/meshes/pvd_writer.hpp"
#include "meniscus/error.hpp"

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

}  // namespace

std::filesystem::path surface_file(const std::filesystem::path& folder, std::uint64_t frame, std::size_t part,
                                   std::size_t parts) {
    const std::size_t digits = std::to_string(parts - 1).size();
    return folder / ("surface-" + padded(frame, frame_digits) + "-part-" + padded(part, digits) + ".vtp");
}

SurfaceList::SurfaceList(std::filesystem::path folder) : folder_(std::move(folder)) {
    formats::make_directory(folder_);
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(list_of(folder_), ignored)))
        throw InvalidInput(list_of(folder_).string() +
                           " is there: name a folder without one, or move away what another run has written");
}

SurfaceList::~SurfaceList() {
    try {
        if (!is_written_) write();
    } catch (const std::exception&) {
        // Of files that could not be written the last push has told.
    }
}

void SurfaceList::add(const Frame& frame) {
    if (!frames_.empty() && !(frames_.back().simulation_time < frame.simulation_time)) times_increase_ = false;
    frames_.push_back(frame);
    is_written_ = false;
}

void SurfaceList::write_in_time() {
    if (!is_written_ && Clock::now() >= next_) write();
}

void SurfaceList::write() {
    const Clock::time_point begin = Clock::now();
    std::vector<formats::PvdEntry> entries;
    for (const Frame& frame : frames_)
        for (std::size_t part = 0; part < frame.parts; ++part)
            entries.push_back({times_increase_ ? frame.simulation_time : static_cast<double>(frame.index),
                               surface_file(folder_, frame.index, part, frame.parts), part});
    formats::write_pvd(list_of(folder_), entries);
    is_written_ = true;
    next_ = Clock::now() + (least_share - 1) * (Clock::now() - begin);
}

}  // namespace meniscus::ranks
