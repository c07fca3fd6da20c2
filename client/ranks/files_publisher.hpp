// Publishes a rank's parts as files of a folder that all makers share. The first maker lists them.
#pragma once

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

    std::filesystem::path folder_;
    std::optional<SurfaceList> list_;  ///< the first maker's
    std::filesystem::path shown_;      ///< the file of a frame that the others have not confirmed; empty: none
};

}  // namespace meniscus::ranks
