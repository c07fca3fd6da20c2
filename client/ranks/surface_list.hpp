// The list of the surfaces that ranks write as files: surface.pvd.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace meniscus::ranks {

/// FOLDER/surface-FRAME-part-PART.vtp
std::filesystem::path surface_file(const std::filesystem::path& folder, std::uint64_t frame, std::size_t part,
                                   std::size_t parts);

/// Names only frames whose files are all there.
class SurfaceList {
public:
    /// Makes the folder if need be. Throws InvalidInput where it cannot, and where the folder has a list already.
    explicit SurfaceList(std::filesystem::path folder);
    /// Writes what write_in_time() has put off, if it can.
    ~SurfaceList();
    SurfaceList(const SurfaceList&) = delete;
    SurfaceList& operator=(const SurfaceList&) = delete;

    struct Frame {
        std::uint64_t index = 0;
        double simulation_time = 0.0;
        std::size_t parts = 1;
    };
    void add(const Frame& frame);
    /// Now, or later: a list of many frames is written again for each of them, and takes a twentieth of the time at
    /// most. Throws as write_pvd(), here and below.
    void write_in_time();
    void write();

private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path folder_;
    std::vector<Frame> frames_;
    bool times_increase_ = true;
    bool is_written_ = true;
    Clock::time_point next_;
};

}  // namespace meniscus::ranks
