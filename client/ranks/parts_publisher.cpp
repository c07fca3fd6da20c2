#include "ranks/parts_publisher.hpp"

#include <algorithm>

#include "ranks/files_publisher.hpp"
#include "ranks/session_publisher.hpp"

namespace meniscus::ranks {
namespace {

constexpr std::chrono::seconds longest_pause{30};

}  // namespace

void PartsPublisher::abandon() noexcept {
    leave();
    next_attempt_ = Clock::now() + pause_;
    pause_ = std::min(2 * pause_, longest_pause);
}

std::unique_ptr<PartsPublisher> make_publisher(const PartsArguments& arguments) {
    if (arguments.output.empty()) return std::make_unique<SessionPublisher>(arguments);
    return std::make_unique<FilesPublisher>(arguments.output);
}

}  // namespace meniscus::ranks
