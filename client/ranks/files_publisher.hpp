// Publishes a rank's parts as files of a folder that all makers share. The first maker lists them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "ranks/parts_publisher.hpp"
#include "ranks/surface_list.hpp"

namespace meniscus::ranks {

class FilesPublisher final : public PartsPublisher {
public:
    /// folder: where the program goes to another one, this stays.
    explicit FilesPublisher(const std::filesystem::path& folder) : folder_(std::filesystem::absolute(folder)) {}

    /// The first maker makes the folder. Throws InvalidInput as SurfaceList, and where another maker does not see it.
    std::string open(const MakerPlace& place) override;
    void finish() override;
    /// Lists it.
    void confirm() noexcept override;

private:
    void show(const LivePart& part) override;
    void leave() noexcept override;

    /// What this maker has written of a frame, until all have theirs.
    struct Shown {
        SurfaceList::Frame frame;
        std::filesystem::path file;  ///< empty: it has no part of the frame
    };
    std::filesystem::path folder_;
    std::optional<SurfaceList> list_;  ///< the first maker's
    std::optional<Shown> shown_;
};

}  // namespace meniscus::ranks
