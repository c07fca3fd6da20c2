// Lies about counts and bytes, indices that do not rise, times that are none.
#include <limits>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

constexpr auto exhausted = grpc::StatusCode::RESOURCE_EXHAUSTED;
constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();

/// A frame_begin and no more: one that is admitted ends its stream within the frame.
std::function<grpc::Status(RunningServer&)> announces(std::uint64_t particles, bool has_levels = false) {
    return after_a_good_frame([=](RawStream& s) { s.call->Write(frame_begin(particles, has_levels)); });
}

/// A frame of ten particles, in chunks of these sizes.
std::function<grpc::Status(RunningServer&)> ten_particles_in(std::vector<std::size_t> chunks) {
    return after_a_good_frame([chunks = std::move(chunks)](RawStream& s) {
        s.send_begin(11, 10);
        for (const std::size_t bytes : chunks) s.send_chunk(bytes);
        s.send_end();
    });
}

/// A frame of one particle that never gets to its bytes.
std::function<grpc::Status(RunningServer&)> empty_chunks(int chunks) {
    return after_a_good_frame([=](RawStream& s) {
        s.send_begin(11, 1);
        for (int i = 0; i < chunks; ++i) s.send_chunk(0);
    });
}

std::function<grpc::Status(RunningServer&)> index(std::uint64_t frame_index) {
    return after_a_good_frame([=](RawStream& s) {
        s.send_begin(frame_index, 0);
        s.send_end();
    });
}

std::function<grpc::Status(RunningServer&)> time(double seconds) {
    return after_a_good_frame([=](RawStream& s) {
        v1::StreamRequest request = frame_begin(0);
        request.mutable_frame_begin()->set_simulation_time(seconds);
        s.call->Write(request);
        s.send_end();
    });
}

}  // namespace

std::vector<BadInputCase> frame_cases() {
    using limits = std::numeric_limits<double>;
    return {
        {"AllBytesInOneChunk", ok, "", ten_particles_in({120})},
        {"AllBytesInChunksThatCutParticles", ok, "", ten_particles_in({1, 0, 118, 1})},
        {"OneByteTooFew", invalid, "frame 11: 119 bytes for 10 particles; 120 were announced", ten_particles_in({119})},
        {"NoBytesAtAll", invalid, "frame 11: 0 bytes for 10 particles; 120 were announced", ten_particles_in({})},
        {"OneByteTooMany", invalid, "frame 11: at least 121 bytes for 10 particles; 120 were announced",
         ten_particles_in({121})},
        {"OneByteTooManyInAChunkOfItsOwn", invalid, "frame 11: at least 121 bytes for 10 particles; 120 were announced",
         ten_particles_in({120, 1})},
        {"BytesOfAnEmptyFrame", invalid, "frame 11: at least 1 bytes for 0 particles; 0 were announced",
         after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 0);
             s.send_chunk(1);
         })},
        {"LevelsThatWereAnnouncedAndDidNotCome", invalid, "frame 11: 12 bytes for 1 particles; 13 were announced",
         after_a_good_frame([](RawStream& s) {
             s.call->Write(frame_begin(1, true));
             s.send_chunk(12);
             s.send_end();
         })},
        {"AChunkOfOneMebibyte", invalid, "the stream ended within frame 11, after 1048576 of 1200000 bytes",
         after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 100'000);
             s.send_chunk(chunk_bytes);
         })},
        {"AChunkOfOneMebibyteAndAByte", invalid, "frame 11: a chunk of 1048577 bytes; at most 1048576 are allowed",
         after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 100'000);
             s.send_chunk(chunk_bytes + 1);
         })},
        {"AsManyChunksAsTheLimit", invalid, "the stream ended within frame 11, after 0 of 12 bytes",
         empty_chunks(1000)},
        {"OneChunkPastTheLimit", exhausted, "frame 11: more than 1000 chunks; the server takes at most 1000 per frame",
         empty_chunks(1001)},
        {"AsManyParticlesAsTheLimit", invalid, "the stream ended within frame 11, after 0 of 12000000 bytes",
         announces(1'000'000)},
        {"OneParticlePastTheLimit", exhausted,
         "frame 11: 1000001 particles; the server takes at most 1000000 per frame", announces(1'000'001)},
        {"AsManyBytesAsTheLimitHolds", invalid, "the stream ended within frame 11, after 0 of 11999988 bytes",
         announces(923'076, true)},
        {"OneParticlePastTheLimitOfBytes", exhausted,
         "frame 11: 923077 particles of 13 bytes; the server holds at most 12000000 bytes per session",
         announces(923'077, true)},
        {"ACountBeyondAllMemory", exhausted, "frame 11: 18446744073709551615 particles", announces(largest)},
        {"ACountWhoseBytesOverflow", exhausted, "frame 11: 1537228672809129302 particles",
         announces(1'537'228'672'809'129'302)},  // 12 times it is 8 modulo 2^64
        {"TheNextIndex", ok, "", index(good_frame + 1)},
        {"TheSameIndexTwice", invalid, "frame index 10 after 10; indices must increase", index(good_frame)},
        {"AnIndexThatGoesBack", invalid, "frame index 9 after 10; indices must increase", index(good_frame - 1)},
        {"TheLargestIndex", ok, "", index(largest)},
        {"AnIndexAfterTheLargest", invalid, "frame index 0 after 18446744073709551615; indices must increase",
         [](RunningServer& running) {
             const CaseSession session(running);
             RawStream stream(running.server.address(), session.id);
             stream.send_begin(largest, 0);
             stream.send_end();
             stream.send_begin(0, 0);
             return stream.finish();
         }},
        {"ATimeBelowZero", ok, "", time(-1.0)},
        {"ATimeOfInfinity", invalid, "frame 11: simulation_time is inf; it must be finite", time(limits::infinity())},
        {"ATimeOfMinusInfinity", invalid, "frame 11: simulation_time is -inf; it must be finite",
         time(-limits::infinity())},
        {"ATimeThatIsNoNumber", invalid, "frame 11: simulation_time is nan; it must be finite",
         time(limits::quiet_NaN())},
    };
}

}  // namespace meniscus::server::test
