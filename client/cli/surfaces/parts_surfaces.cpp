#include "cli/surfaces/parts_surfaces.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

/// The attributes' ranges over the vertices of two parts.
void widen(std::vector<client::FrameAttribute>& attributes, const std::vector<client::FrameAttribute>& others) {
    for (std::size_t a = 0; a < attributes.size(); ++a) {
        std::optional<AttributeRange>& range = attributes[a].range;
        const std::optional<AttributeRange>& other = others[a].range;
        if (!range) range = other;
        if (!other) continue;
        for (std::size_t c = 0; c < attributes[a].components; ++c) {
            range->minimum[c] = std::min(range->minimum[c], other->minimum[c]);
            range->maximum[c] = std::max(range->maximum[c], other->maximum[c]);
        }
    }
}

bool comes_before(const std::shared_ptr<const EncodedBrick>& a, const std::shared_ptr<const EncodedBrick>& b) {
    return std::lexicographical_compare(a->coordinate.rbegin(), a->coordinate.rend(), b->coordinate.rbegin(),
                                        b->coordinate.rend());
}

/// Takes the bricks and the rest of another part of the same frame.
void take_part(client::ReceivedFrame& whole, client::ReceivedFrame part) {
    std::move(part.bricks.begin(), part.bricks.end(), std::back_inserter(whole.bricks));
    whole.spray.insert(whole.spray.end(), part.spray.begin(), part.spray.end());
    widen(whole.attributes, part.attributes);
    whole.statistics.encoded_bytes += part.statistics.encoded_bytes;
    whole.statistics.encode_seconds += part.statistics.encode_seconds;
}

}  // namespace

PartsSurfaces::PartsSurfaces(const Settings& settings, const BackendOptions& backend, std::size_t parts,
                             LocalCoding coding, bool as_bricks, Handler handler)
    : reconstructor_(settings, backend, {.parts = parts}, alone_),
      coding_(coding),
      as_bricks_(as_bricks),
      handler_(std::move(handler)) {
    if (as_bricks && coding_.attribute_bits != 0)
        throw InvalidInput("--attribute-bits " + std::to_string(coding_.attribute_bits) +
                           " is over the range of the whole surface, and with --parts bricks are encoded before that "
                           "is known: give --attribute-bits 0, or another format");
}

void PartsSurfaces::submit(const ParticleFrame& frame, double simulation_time) {
    meshes_.clear();
    encoded_.clear();
    const PartsReport report = reconstructor_.reconstruct(frame, [&](const FinishedPart& part) {
        if (!as_bricks_) {
            meshes_[part.number] = std::move(part.mesh);
            return;
        }
        const CodingOptions coding = coding_.round(part.mesh);
        encoded_[part.number] = client::encode_frame(part.mesh, part.statistics, frames_, simulation_time, coding);
    });
    client::FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = report.whole;
    as_bricks_ ? hand_over_bricks(std::move(statistics)) : hand_over_mesh(std::move(statistics), simulation_time);
    ++frames_;
}

void PartsSurfaces::hand_over_mesh(client::FrameStatistics statistics, double simulation_time) {
    std::vector<Mesh> parts;
    for (auto& [number, mesh] : meshes_) parts.push_back(std::move(mesh));
    Mesh whole = put_together(parts);
    parts.clear();
    const CodingOptions coding = coding_.round(whole);
    Surface surface(whole, std::move(statistics), frames_, simulation_time, coding);
    handler_(surface);
}

void PartsSurfaces::hand_over_bricks(client::FrameStatistics statistics) {
    client::ReceivedFrame whole = std::move(encoded_.begin()->second);
    for (auto part = std::next(encoded_.begin()); part != encoded_.end(); ++part)
        take_part(whole, std::move(part->second));
    std::sort(whole.bricks.begin(), whole.bricks.end(), comes_before);
    statistics.encoded_bytes = whole.statistics.encoded_bytes;
    statistics.encode_seconds = whole.statistics.encode_seconds;
    whole.statistics = std::move(statistics);
    Surface surface(whole);
    handler_(surface);
}

}  // namespace meniscus::cli
