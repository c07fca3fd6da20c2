#include "ranks/parts_publisher.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "meniscus/client/surface_part.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::ranks {

PartsPublisher::PartsPublisher(const PartsArguments& arguments)
    : server_(arguments.server),
      connection_(arguments.connection),
      session_(arguments.session),
      coding_(arguments.coding),
      wishes_(arguments.wishes) {
    Reconstructor reconstructor(arguments.settings, {.backend = Backend::cpu, .threads = 1});
    reconstructor.reconstruct(ParticleFrame(), empty_);
    of_empty_ = reconstructor.statistics();
}

void PartsPublisher::open(std::size_t part, std::size_t parts, std::uint64_t run, const std::string& session_id) {
    run_ = run;
    session_.insert_or_assign("parts", std::to_string(parts));
    session_.insert_or_assign("part", std::to_string(part));
    if (!session_id.empty()) session_.insert_or_assign("session", session_id);
    open();
    session_id_ = upload_->session_id();
    // A server that starts is waited for, one that went away is not.
    connection_.erase("wait");
    session_.insert_or_assign("session", session_id_);
}

void PartsPublisher::open() {
    session_.insert_or_assign("run", std::to_string(run_));
    upload_ = open_brick_upload(server_, connection_, session_);
}

void PartsPublisher::finish() {
    if (upload_ != nullptr) upload_->finish();
}

void PartsPublisher::publish(const LivePart& part) {
    const client::ReceivedFrame frame = encoded(part);
    if (upload_ == nullptr) open();
    upload_->push(frame);
    pause_ = first_pause;
}

void PartsPublisher::abandon() noexcept {
    // It stays for those that watch it.
    if (upload_ != nullptr) upload_->leave();
    upload_ = nullptr;
    ++run_;
    next_attempt_ = Clock::now() + pause_;
    pause_ = std::min(2 * pause_, longest_pause);
}

client::ReceivedFrame PartsPublisher::encoded(const LivePart& part) const {
    const Mesh& mesh = part.mesh != nullptr ? *part.mesh : empty_;
    SurfacePart own{.bricks = std::vector<std::uint32_t>(mesh.bricks.size()),
                    .ranges = part.report.ranges,
                    .spray = {mesh.spray.begin(), mesh.spray.end()},
                    .statistics = part.mesh != nullptr ? part.statistics : of_empty_};
    std::iota(own.bricks.begin(), own.bricks.end(), 0U);
    CodingOptions coding = coding_;
    coding.attributes = coded_attributes(mesh, own.ranges, wishes_);
    return client::encode_part(mesh, std::move(own), part.index, part.simulation_time, std::move(coding));
}

}  // namespace meniscus::ranks
