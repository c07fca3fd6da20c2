#include "ranks/session_publisher.hpp"

#include <numeric>
#include <utility>
#include <vector>

#include "meniscus/client/surface_part.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::ranks {

SessionPublisher::SessionPublisher(const PartsArguments& arguments)
    : server_(arguments.server),
      connection_(arguments.connection),
      session_(arguments.session),
      coding_(arguments.coding),
      wishes_(arguments.wishes) {
    Reconstructor reconstructor(arguments.settings, {.backend = Backend::cpu, .threads = 1});
    reconstructor.reconstruct(ParticleFrame(), empty_);
    of_empty_ = reconstructor.statistics();
}

std::string SessionPublisher::open(const MakerPlace& place) {
    run_ = place.run;
    session_.insert_or_assign("parts", std::to_string(place.makers));
    session_.insert_or_assign("part", std::to_string(place.number));
    if (!place.session_id.empty()) session_.insert_or_assign("session", place.session_id);
    open_upload();
    // A server that starts is waited for, one that went away is not.
    connection_.erase("wait");
    session_.insert_or_assign("session", upload_->session_id());
    return upload_->session_id();
}

void SessionPublisher::open_upload() {
    session_.insert_or_assign("run", std::to_string(run_));
    upload_ = open_brick_upload(server_, connection_, session_);
}

void SessionPublisher::finish() {
    if (upload_ != nullptr) upload_->finish();
}

void SessionPublisher::show(const LivePart& part) {
    const client::ReceivedFrame frame = encoded(part);
    if (upload_ == nullptr) open_upload();
    upload_->push(frame);
}

void SessionPublisher::leave() noexcept {
    // It stays for those that watch it.
    if (upload_ != nullptr) upload_->leave();
    upload_ = nullptr;
    ++run_;
}

client::ReceivedFrame SessionPublisher::encoded(const LivePart& part) const {
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
