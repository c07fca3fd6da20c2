// Frames of finished bricks, from one publisher or from several.
#include <google/protobuf/io/coded_stream.h>

#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conversion/attribute_conversion.hpp"
#include "conversion/brick_conversion.hpp"
#include "conversion/spray_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/brick_reader.hpp"
#include "sessions/intake/frame_assembler.hpp"
#include "sessions/intake/frame_plan.hpp"
#include "sessions/sending/brick_messages.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

namespace {

constexpr std::size_t most_parts = 4;

/// Those of sample_mesh().
Settings sample_settings(bool attributes) {
    Settings settings;
    settings.particle_radius = 0.1;
    settings.cell_size = 1.0;
    settings.all_attributes = attributes;
    return settings;
}

server::BrickReader reader(const Settings& settings, server::BrickReader::Check check) {
    return {settings, check, std::make_shared<server::WorkerPool>(1),
            std::make_shared<MemoryAccount>(std::size_t{64} << 20), nullptr};
}

/// What a frame that was taken holds, in the form in which it came and in others.
void require_whole(const server::InputFrame& input, const server::ReconstructedFrame& frame) {
    const server::FinishedBricks& finished = *frame.finished;
    std::uint64_t announced = 0;
    for (const server::BrickPart& part : input.brick_parts) announced += part.bricks;
    require(finished.bricks.size() == announced, "as many bricks as announced");
    require(frame.statistics.triangles == finished.triangles, "as many triangles as the statistics say");
    require(frame.ranges.back()->size() == (announced == 0 ? 0 : finished.attributes.size()),
            "a range for each attribute");
    BrickScratch scratch;
    for (const Codec codec : codecs) {
        const CodingOptions options{.normal_bits = finished.normal_bits == 0 ? 0 : 6, .codec = codec};
        const server::RecodedBricks recoded(finished, options);
        for (std::size_t i = 0; i < finished.bricks.size(); ++i) {
            const EncodedBrick brick = server::encoded_brick(*recoded.brick(i, {}, scratch));
            const DecodedBrick decoded = decode_brick(brick, finished.offset_bits);
            require(decoded.triangles.size() == finished.bricks[i]->triangles, "a recoded brick has its triangles");
        }
    }
}

}  // namespace

void finished_bricks(Bytes bytes) {
    server::Limits limits;
    limits.bytes_per_session = std::size_t{1} << 20;
    Front front(bytes);
    const std::uint32_t choice = front.number(1);
    const Settings settings = sample_settings(choice % 2 == 1);
    const auto check =
        choice / 2 % 2 == 1 ? server::BrickReader::Check::closed_surface : server::BrickReader::Check::each_brick;
    server::InputFrame input(std::make_shared<MemoryAccount>(limits.bytes_per_session));
    may_refuse([&] {
        std::vector<server::FramePart> parts;
        const std::size_t count = 1 + front.number(1) % most_parts;
        for (std::size_t p = 0; p < count; ++p) {
            const Bytes message = front.piece(front.number(2));
            v1::PublishBegin begin;
            if (!begin.ParseFromArray(message.data(), static_cast<int>(message.size()))) return;
            begin.mutable_mesh()->set_frame_index(7);
            parts.push_back(server::FrameAssembler(limits, settings).announce(begin));
        }
        server::begin_frame(parts, limits, input);
        const Bytes sent = front.rest().substr(0, input.bytes.size());
        std::memcpy(input.bytes.data(), sent.data(), sent.size());
        std::memset(input.bytes.data() + sent.size(), 0, input.bytes.size() - sent.size());
        server::ReconstructedFrame frame;
        server::BrickReader first = reader(settings, check);
        first.read(input, frame);
        require_whole(input, frame);
        const auto known = frame.finished;
        first.read(input, frame);
        require(frame.finished->bricks == known->bricks, "bricks of the frame before are known");
    });
}

Seeds finished_bricks_seeds() {
    Seeds seeds;
    for (const bool attributes : {false, true})
        for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy})
            for (const std::size_t count : {1, 2}) {
                const Mesh mesh = sample_mesh(attributes);
                CodingOptions options{.codec = codec};
                const std::vector<AttributeRange> ranges = attribute_ranges(mesh);
                const std::vector<AttributeWish> all{{.name = {}, .bits = 8}};
                options.attributes = coded_attributes(mesh, ranges, all);
                std::vector<v1::PublishBegin> begins(count);
                std::vector<std::string> content(count);
                for (v1::PublishBegin& begin : begins) {
                    v1::MeshBegin& announced = *begin.mutable_mesh();
                    announced.set_cell_size(mesh.cell_size);
                    announced.set_offset_bits(mesh.offset_bits);
                    announced.set_brick_cells(static_cast<std::uint32_t>(brick_cells));
                    conversion::to_wire(mesh, ranges, options.attributes, announced);
                }
                for (std::size_t b = 0; b < mesh.bricks.size(); ++b) {
                    const EncodedBrick brick = encode_brick(mesh, b, options);
                    v1::PublishBegin& begin = begins[b % count];
                    v1::MeshBegin& announced = *begin.mutable_mesh();
                    announced.set_brick_count(announced.brick_count() + 1);
                    announced.set_triangle_count(announced.triangle_count() + brick.triangles);
                    begin.mutable_statistics()->set_triangles(announced.triangle_count());
                    const server::SharedBrick sent = server::brick_messages(brick, {});
                    for (const server::SharedMessage& message : sent->messages) {
                        std::uint8_t length[5];
                        const std::uint8_t* const end = google::protobuf::io::CodedOutputStream::WriteVarint32ToArray(
                            static_cast<std::uint32_t>(message->size()), static_cast<std::uint8_t*>(length));
                        content[b % count].append(reinterpret_cast<const char*>(length),
                                                  static_cast<std::size_t>(end - length));
                        content[b % count] += *message;
                    }
                }
                std::string seed = number_bytes(attributes ? 3 : 2, 1);
                seed += number_bytes(static_cast<std::uint32_t>(count - 1), 1);
                for (std::size_t p = 0; p < count; ++p) begins[p].set_byte_count(content[p].size());
                seed += join(begins);
                for (const std::string& of_part : content) seed += of_part;
                seeds.push_back(std::move(seed));
            }
    return seeds;
}

}  // namespace meniscus::fuzz
