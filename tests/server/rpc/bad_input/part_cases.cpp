// Parts of frames that do not fit each other, or their frame.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

/// One part of a new session's two.
struct TwoParts {
    explicit TwoParts(RunningServer& running)
        : session(running),
          first(running.server.address(), session.id, false),
          second(running.server.address(), session.id, false) {
        open(first, 0, 2);
        open(second, 1, 2);
    }

    void open(RawStream& stream, std::uint32_t part, std::uint32_t parts,
              const std::function<void(v1::StreamOpen&)>& change = {}) const {
        v1::StreamRequest request;
        v1::StreamOpen& message = *request.mutable_open();
        message.set_session_id(session.id);
        message.set_run_id(7);
        message.set_parts(parts);
        message.set_part(part);
        if (change) change(message);
        stream.call->Write(request);
    }
    void send(RawStream& stream, const v1::StreamRequest& request) const { stream.call->Write(request); }
    /// The status of both, which must be the same. The second one sends no more; the first is ended by that.
    grpc::Status finish() {
        second.call->WritesDone();
        grpc::Status of_second = second.finish();
        const grpc::Status of_first = first.finish();
        EXPECT_EQ(of_first.error_message(), of_second.error_message());
        EXPECT_EQ(of_first.error_code(), of_second.error_code());
        return of_second;
    }

    CaseSession session;
    RawStream first;
    RawStream second;
};

/// The status of both parts for such beginnings of a frame of one particle each.
std::function<grpc::Status(RunningServer&)> begin_with(std::function<void(v1::FrameBegin&)> second,
                                                       std::function<void(v1::FrameBegin&)> both = {}) {
    return [second = std::move(second), both = std::move(both)](RunningServer& running) {
        TwoParts parts(running);
        v1::StreamRequest begin = frame_begin(1);
        if (both) both(*begin.mutable_frame_begin());
        parts.send(parts.first, begin);
        second(*begin.mutable_frame_begin());
        parts.send(parts.second, begin);
        return parts.finish();
    };
}

/// The status of both parts, of which the second sends this after the beginning of its frame of one particle.
std::function<grpc::Status(RunningServer&)> second_sends(std::function<void(RawStream&)> send) {
    return [send = std::move(send)](RunningServer& running) {
        TwoParts parts(running);
        parts.send(parts.first, frame_begin(1));
        parts.first.send_chunk(12);
        parts.first.send_end();
        parts.send(parts.second, frame_begin(1));
        send(parts.second);
        return parts.finish();
    };
}

/// The status of a part that opens beside part 1 of 2.
std::function<grpc::Status(RunningServer&)> opens_beside(std::uint32_t part, std::uint32_t parts,
                                                         std::function<void(v1::StreamOpen&)> change = {}) {
    return [=, change = std::move(change)](RunningServer& running) {
        TwoParts all(running);
        // So that both are there.
        v1::StreamRequest end;
        end.mutable_frame_end();
        for (RawStream* stream : {&all.first, &all.second}) {
            all.send(*stream, frame_begin(0));
            all.send(*stream, end);
        }
        v1::StreamResponse answer;
        all.first.call->Read(&answer);
        all.second.call->Read(&answer);
        RawStream other(running.server.address(), all.session.id, false);
        all.open(other, part, parts, change);
        other.call->WritesDone();
        grpc::Status status = other.finish();
        all.finish();
        return status;
    };
}

std::function<grpc::Status(RunningServer&)> open_alone(std::uint32_t part, std::uint32_t parts, std::uint64_t run) {
    return [=](RunningServer& running) {
        const CaseSession session(running);
        RawStream stream(running.server.address(), session.id, false);
        v1::StreamRequest request;
        request.mutable_open()->set_session_id(session.id);
        request.mutable_open()->set_run_id(run);
        request.mutable_open()->set_parts(parts);
        request.mutable_open()->set_part(part);
        stream.call->Write(request);
        stream.call->WritesDone();
        return stream.finish();
    };
}

void set_corner(v1::Vector3& corner, double number) {
    corner.set_x(number);
    corner.set_y(number);
    corner.set_z(number);
}

/// Positions of uint16 over a box from 0 to this.
void quantize(v1::FrameBegin& begin, double most) {
    *begin.mutable_arrays() = conversion::particle_arrays(true, false);
    set_corner(*begin.mutable_quantization_box()->mutable_min(), 0.0);
    set_corner(*begin.mutable_quantization_box()->mutable_max(), most);
}

}  // namespace

std::vector<BadInputCase> part_cases() {
    return {
        {"APartBehindTheLast", invalid, "part is 2 of 2 parts; they are counted from 0", open_alone(2, 2, 7)},
        {"APartOfAWholeFrame", invalid, "part is 1 of 1 parts; they are counted from 0", open_alone(1, 0, 7)},
        {"TheOnlyPart", ok, "", open_alone(0, 1, 0)},
        {"MorePartsThanTheServerTakes", invalid, "parts is 257; a frame has at most 256", open_alone(0, 257, 7)},
        {"PartsOfNoRun", invalid, "run_id is 0, and parts is 2: all parts name the same run", open_alone(0, 2, 0)},
        {"APartOfOtherParts", invalid, "part 2 says parts 3, the parts before it 2; it is the same for all parts",
         opens_beside(2, 3)},
        {"APartWithAnotherPolicy", invalid, "part 1 says policy ",
         opens_beside(1, 2, [](v1::StreamOpen& open) { open.set_policy(v1::UPLOAD_POLICY_LATEST); })},
        {"APartOfAnotherRun", grpc::StatusCode::FAILED_PRECONDITION, "another stream uploads to session ",
         opens_beside(1, 2, [](v1::StreamOpen& open) { open.set_run_id(8); })},
        {"PartsAtTwoTimes", invalid,
         "simulation_time of part 1 is 2, and 0 in part 0; in all parts of a frame it is the same",
         begin_with([](v1::FrameBegin& begin) { begin.set_simulation_time(2.0); })},
        {"PartsOfFloatsAndOfIntegers", invalid, "array 'position' of part 1 is uint16, and float32 in part 0",
         begin_with([](v1::FrameBegin& begin) { quantize(begin, 1.0); })},
        {"PartsOverTwoBoxes", invalid,
         "quantization_box of part 1 is (0, 0, 0) to (2, 2, 2), and (0, 0, 0) to (1, 1, 1) in part 0",
         begin_with([](v1::FrameBegin& begin) { quantize(begin, 2.0); },
                    [](v1::FrameBegin& begin) { quantize(begin, 1.0); })},
        {"PartsOfWhichOneHasLevels", invalid, "array 'level' of part 1 is there, and missing in part 0",
         begin_with([](v1::FrameBegin& begin) { *begin.mutable_arrays() = conversion::particle_arrays(false, true); })},
        {"PartsOfMoreParticlesThanCanBeCounted", grpc::StatusCode::RESOURCE_EXHAUSTED,
         "18446744073709551615 particles; the server takes at most ",
         begin_with([](v1::FrameBegin& begin) { begin.set_particle_count(~std::uint64_t{0}); },
                    [](v1::FrameBegin& begin) { begin.set_particle_count(~std::uint64_t{0}); })},
        {"APartThatIsPassedOverAndCannotBeCounted", grpc::StatusCode::RESOURCE_EXHAUSTED,
         "part 0 of 2: frame 11: 4611686018427387904 particles of 12 bytes; the server takes at most ",
         begin_with(
             [](v1::FrameBegin& begin) {
                 begin.set_frame_index(begin.frame_index() + 1);
                 begin.set_particle_count(1);
             },
             [](v1::FrameBegin& begin) { begin.set_particle_count(std::uint64_t{1} << 62); })},
        {"MoreBytesOfAPartThanAnnounced", invalid,
         "part 1 of 2: frame 11: at least 13 bytes for 1 particles; 12 were announced",
         second_sends([](RawStream& stream) { stream.send_chunk(13); })},
        {"FewerBytesOfAPartThanAnnounced", invalid,
         "part 1 of 2: frame 11: 11 bytes for 1 particles; 12 were announced", second_sends([](RawStream& stream) {
             stream.send_chunk(11);
             stream.send_end();
         })},
        {"APartThatEndsTwice", invalid, "part 1 of 2: frame_end outside of a frame; frame_begin comes first",
         [](RunningServer& running) {
             TwoParts parts(running);
             parts.send(parts.first, frame_begin(0));
             parts.send(parts.second, frame_begin(0));
             parts.first.send_end();
             parts.second.send_end();
             parts.second.send_end();
             return parts.finish();
         }},
        {"APartThatBeginsTwice", invalid, "part 1 of 2: frame 11 begins before frame 11 has ended",
         second_sends([](RawStream& stream) { stream.call->Write(frame_begin(1)); })},
        {"APartThatNeverEnds", grpc::StatusCode::ABORTED, "part 1 of 2 has broken off",
         second_sends([](RawStream& /*stream*/) {})},
    };
}

}  // namespace meniscus::server::test
