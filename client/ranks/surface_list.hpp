// The list of the surfaces that ranks write as files: surface.pvd.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::ranks {

/// The name of a part's file in the folder: surface-FRAME-part-PART.vtp
std::string surface_name(std::uint64_t frame, std::size_t part, std::size_t parts);

/// Names only frames whose files are all there.
class SurfaceList {
public:
    /// Makes the folder if need be, and in it a list without frames, so that no other job writes there. run: names the
    /// job. Throws InvalidInput where it cannot, and where there is a list already.
    SurfaceList(std::filesystem::path folder, std::uint64_t run);
    /// Writes what write_in_time() has put off, if it can. A list without frames goes.
    ~SurfaceList();
    SurfaceList(const SurfaceList&) = delete;
    SurfaceList& operator=(const SurfaceList&) = delete;

    /// Whether this run's list, still without frames yet, is in the folder.
    static bool is_in(const std::filesystem::path& folder, std::uint64_t run);

    struct Frame {
        std::uint64_t index = 0;
        double simulation_time = 0.0;
        std::size_t parts = 1;
    };
    /// A frame that is listed once confirm() says that it is whole.
    void add(const Frame& frame);
    void confirm() noexcept { whole_ = frames_.size(); }
    /// It is not.
    void withdraw() noexcept { frames_.resize(whole_); }
    /// Now, or later: a list of many frames is written again for each of them, and takes about a twentieth of the time
    /// at most. Throws as PvdWriter, but ProcessFailed for a path that cannot be written, here and below.
    void write_in_time();
    void write();

private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path folder_;
    std::vector<Frame> frames_;
    std::size_t whole_ = 0;    ///< of them, the first ones
    std::size_t written_ = 0;  ///< of these, in the list as it is
    Clock::time_point next_;
};

}  // namespace meniscus::ranks
