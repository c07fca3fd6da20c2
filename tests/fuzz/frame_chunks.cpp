#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <span>

#include "meniscus/v1/surface_service.pb.h"
#include "rpc/messages/frame_chunk_reader.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

/// The first byte says in pieces of which size the message lies in memory.
void frame_chunks(Bytes bytes) {
    Front front(bytes);
    const int piece = 1 + static_cast<int>(front.number(1));
    const Bytes message = front.rest();
    google::protobuf::io::ArrayInputStream stream(message.data(), static_cast<int>(message.size()), piece);
    server::FrameChunkReader reader(stream, message.size());
    if (!reader.bytes()) return;
    require(*reader.bytes() <= message.size(), "a chunk is not longer than its message");
    std::string data(*reader.bytes(), '\0');
    reader.copy_to(std::as_writable_bytes(std::span(data)));
    v1::StreamRequest request;
    require(request.ParseFromArray(message.data(), static_cast<int>(message.size())),
            "what the reader takes is a message");
    require(request.has_frame_chunk() && request.frame_chunk().data() == data,
            "the reader finds the bytes that protobuf finds");
    require(request.SerializeAsString() == message, "the message holds nothing else");
}

Seeds frame_chunk_seeds() {
    Seeds seeds;
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{200}, std::size_t{20'000}}) {
        v1::StreamRequest request;
        request.mutable_frame_chunk()->set_data(std::string(size, '\x07'));
        for (const char piece : {'\x10', '\xff'})
            seeds.push_back(std::string(1, piece).append(request.SerializeAsString()));
    }
    return seeds;
}

}  // namespace meniscus::fuzz
