// Messages that come at the wrong time, and bytes that are no message.
#include <utility>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

/// The status of a stream with these messages that has not been opened.
std::function<grpc::Status(RunningServer&)> instead_of_open(std::function<void(RawStream&)> send) {
    return [send = std::move(send)](RunningServer& running) {
        const CaseSession session(running);
        RawStream stream(running.server.address(), session.id, false);
        send(stream);
        stream.call->WritesDone();
        return stream.finish();
    };
}

/// After a frame_begin, a frame_chunk of these bytes.
std::function<grpc::Status(RunningServer&)> chunk_message(std::string bytes) {
    return after_a_good_frame([bytes = std::move(bytes)](RawStream& s) {
        s.send_begin(11, 1);
        s.call->Write(with_raw_field<v1::StreamRequest>(v1::StreamRequest::kFrameChunkFieldNumber, bytes));
    });
}

}  // namespace

std::vector<BadInputCase> message_order_cases() {
    return {
        {"AFirstMessageThatIsNotOpen", invalid, "the first message of a stream must be open",
         instead_of_open([](RawStream& s) { s.send_begin(0, 0); })},
        {"AStreamWithoutAnyMessage", invalid, "the stream ended before its first message, open",
         instead_of_open([](RawStream&) {})},
        {"AnEmptyFirstMessage", invalid, "the first message of a stream must be open",
         instead_of_open([](RawStream& s) { s.call->Write({}); })},
        {"ASecondOpen", invalid, "a second open; a stream has one, its first message",
         after_a_good_frame([](RawStream& s) {
             v1::StreamRequest request;
             request.mutable_open();
             s.call->Write(request);
         })},
        {"AMessageWithoutAKind", invalid, "a message of no kind: it has no field",
         after_a_good_frame([](RawStream& s) { s.call->Write({}); })},
        {"AMessageOfAKindOfTheFuture", invalid, "a message with the field 99, a kind that this version does not know",
         after_a_good_frame([](RawStream& s) { s.call->Write(with_raw_field<v1::StreamRequest>(99, "?")); })},
        {"AChunkOutsideOfAFrame", invalid, "a chunk outside of a frame; frame_begin comes first",
         after_a_good_frame([](RawStream& s) { s.send_chunk(12); })},
        {"AFrameEndOutsideOfAFrame", invalid, "frame_end outside of a frame; frame_begin comes first",
         after_a_good_frame([](RawStream& s) { s.send_end(); })},
        {"AFrameWithinAFrame", invalid, "frame 12 begins before frame 11 has ended",
         after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 1);
             s.send_begin(12, 1);
         })},
        {"AnOpenWithinAFrame", invalid, "a second open", after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 1);
             v1::StreamRequest request;
             request.mutable_open();
             s.call->Write(request);
         })},
        {"AStreamThatEndsAfterFrameBegin", invalid, "the stream ended within frame 11, after 0 of 12 bytes",
         after_a_good_frame([](RawStream& s) { s.send_begin(11, 1); })},
        {"AStreamThatEndsWithinAFrame", invalid, "the stream ended within frame 11, after 5 of 12 bytes",
         after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 1);
             s.send_chunk(5);
         })},
        {"AStreamThatEndsWithoutFrameEnd", invalid, "the stream ended within frame 11, after 12 of 12 bytes",
         after_a_good_frame([](RawStream& s) {
             s.send_begin(11, 1);
             s.send_chunk(12);
         })},
        {"ATruncatedChunk", invalid, "is not a StreamRequest", chunk_message(std::string("\x0a\x0c\x01\x02", 4))},
        {"AChunkWithoutItsLength", invalid, "is not a StreamRequest", chunk_message("\x0a")},
        {"AChunkWithAnEndlessLength", invalid, "is not a StreamRequest",
         chunk_message("\x0a\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff")},
        {"AChunkWithALengthOfAllMemory", invalid, "is not a StreamRequest",
         chunk_message("\x0a\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01")},
        {"AChunkWithTheFieldNumberZero", invalid, "is not a StreamRequest", chunk_message(std::string("\x02\x00", 2))},
        {"AChunkWithAGroupThatNeverBegan", invalid, "is not a StreamRequest", chunk_message("\x0c")},
        {"ATruncatedFrameBegin", invalid, "is not a StreamRequest", after_a_good_frame([](RawStream& s) {
             s.call->Write(with_raw_field<v1::StreamRequest>(v1::StreamRequest::kFrameBeginFieldNumber, "\x08\xff"));
         })},
        {"ATruncatedOpen", invalid, "is not a StreamRequest", instead_of_open([](RawStream& s) {
             s.call->Write(with_raw_field<v1::StreamRequest>(v1::StreamRequest::kOpenFieldNumber, "\x0a\x24only this"));
         })},
    };
}

}  // namespace meniscus::server::test
