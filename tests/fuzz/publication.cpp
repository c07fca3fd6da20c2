#include "meniscus/client/publication.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include "formats/recordings/brick_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "meniscus/sha256.hpp"
#include "publications/segment.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

namespace {

constexpr const char* manifest = "manifest.json";

/// The manifest of one segment.
std::string manifest_of(Bytes segment, std::uint32_t frames, std::uint32_t first, std::uint32_t last) {
    const std::string size = std::to_string(segment.size());
    const std::string count = std::to_string(frames);
    return R"({"format": "Meniscus publication", "version": 1, "frames": ")" + count + R"(", "bytes": ")" + size +
           R"(", "segments": [{"sha256": ")" + sha256_of(segment) + R"(", "bytes": )" + size + R"(, "frames": )" +
           count + R"(, "first_frame": ")" + std::to_string(first) + R"(", "last_frame": ")" + std::to_string(last) +
           R"("}]})";
}

/// Two frames of the same few particles, the second of which lies elsewhere.
client::SegmentBuilder::Built two_frames() {
    Settings settings;
    settings.particle_radius = 0.125;
    Reconstructor reconstructor(settings, {.threads = 1, .keep_lattice = true});
    client::SegmentBuilder builder;
    for (const float x : {0.0F, 0.5F}) {
        Mesh mesh;
        const std::vector<float> positions{x, 0, 0, 0.25F, 0, 0, 8, 0, 0};
        ParticleFrame frame;
        frame.positions = positions;
        reconstructor.reconstruct(frame, mesh);
        builder.add(client::encode_frame(mesh, reconstructor.statistics(), x > 0 ? 1 : 0, 0.0,
                                         {.codec = Codec::lattice_packed}),
                    0.04);
    }
    return builder.build();
}

}  // namespace

void publication_manifest(Bytes bytes) {
    may_refuse([&] {
        client::Publication publication("p", [&](const std::string& name, std::uint64_t most) -> std::string {
            require(name == manifest || (name.size() == 72 && name.find('/') == std::string::npos),
                    "files beside the manifest alone are read");
            require(most < (std::uint64_t{1} << 31), "no file is larger than any");
            if (name == manifest) return std::string(bytes);
            throw InvalidInput("no such file");
        });
        const client::PublicationInfo& info = publication.info();
        std::uint64_t frames = 0;
        for (const client::PublishedSegment& segment : info.segments) frames += segment.frames;
        require(frames == info.frames, "as many frames as the segments have");
        if (frames > 0) (void)publication.frame(info.left_frames + frames - 1);
    });
}

void publication_segment(Bytes bytes) {
    Front front(bytes);
    const std::uint32_t frames = front.number(1);
    const std::uint32_t first = front.number(1);
    const std::uint32_t last = front.number(1);
    const Bytes segment = front.rest();
    may_refuse([&] {
        client::Publication publication("p", [&](const std::string& name, std::uint64_t) {
            return name == manifest ? manifest_of(segment, frames, first, last) : std::string(segment);
        });
        for (std::uint64_t place = 0; place < publication.info().frames; ++place) {
            const client::ReceivedFrame frame = publication.frame(place);
            require(frame.index >= first && frame.index <= last, "the frames that the manifest says");
            may_refuse([&] { (void)frame.mesh(); });
        }
    });
}

Seeds publication_manifest_seeds() {
    const auto built = two_frames();
    return {manifest_of(built.bytes, 2, 0, 1), manifest_of(built.bytes, 1, 7, 7)};
}

Seeds publication_segment_seeds() {
    return {std::string("\x02\x00\x01", 3) + two_frames().bytes};
}

}  // namespace meniscus::fuzz
