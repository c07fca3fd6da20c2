#include "ranks/surface_list.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <fstream>
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
    return "<?xml version=\"1.0\"?>\n<!-- run " + std::to_string(run) +
           " has no frames yet -->\n"
           "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\"><Collection/></VTKFile>\n";
}

/// Writes a file that was not there. Throws InvalidInput.
void make_file(const std::filesystem::path& path, const std::string& text) {
    errno = 0;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST)
        throw InvalidInput(path.string() +
                           " is there: name a folder without one, or move away what another run has written");
    const bool is_written = descriptor >= 0 && ::write(descriptor, text.data(), text.size()) == ssize_t(text.size());
    const int error = descriptor >= 0 && errno == 0 ? ENOSPC : errno;  // of which a part was written
    if (descriptor >= 0) ::close(descriptor);
    if (is_written) return;
    if (descriptor >= 0) ::unlink(path.c_str());
    throw InvalidInput(path.string() + ": cannot be written: " + std::generic_category().message(error));
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
        if (!is_written_) write();
        if (frames_.empty()) std::filesystem::remove(list_of(folder_));
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

void SurfaceList::add(const Frame& frame) noexcept {
    if (!frames_.empty() && !(frames_.back().simulation_time < frame.simulation_time)) times_increase_ = false;
    frames_.push_back(frame);
    is_written_ = false;
}

void SurfaceList::write_in_time() {
    if (!is_written_ && Clock::now() >= next_) write();
}

void SurfaceList::write() {
    const Clock::time_point begin = Clock::now();
    try {
        formats::PvdWriter list(list_of(folder_));
        for (const Frame& frame : frames_) {
            std::string time;
            times_increase_ ? append_shortest(time, frame.simulation_time) : append_shortest(time, frame.index);
            for (std::size_t part = 0; part < frame.parts; ++part)
                list.add(time, part, surface_name(frame.index, part, frame.parts));
        }
        list.commit();
    } catch (const InvalidInput& error) {
        throw ProcessFailed(error.what());  // no argument of a caller is wrong
    }
    is_written_ = true;
    next_ = Clock::now() + (least_share - 1) * (Clock::now() - begin);
}

}  // namespace meniscus::ranks
