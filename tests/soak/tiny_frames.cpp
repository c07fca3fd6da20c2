#include "tiny_frames.hpp"

#include <stdexcept>

namespace meniscus::soak {

namespace {

client::Stream open_stream(client::Client& client) {
    Settings settings;
    settings.particle_radius = 0.1;
    const std::string session = client::new_session_id();
    client.create_session(session, settings);
    return client.stream(session);
}

}  // namespace

TinyFrames::TinyFrames(const std::string& server) : client_(server), stream_(open_stream(client_)) {}

void TinyFrames::push() {
    ParticleFrame frame;
    frame.positions = position_;
    stream_.push(frame, sent_, 0.0);
    ++sent_;
}

void TinyFrames::expect_answer() {
    const auto frame = stream_.next();
    if (!frame || frame->index != answered_)
        throw std::runtime_error("frame " + std::to_string(answered_) + " was not answered in its turn");
    ++answered_;
}

void TinyFrames::send(std::uint64_t frames) {
    constexpr std::uint64_t in_flight = 32;
    const std::uint64_t last = sent_ + frames;
    while (answered_ < last) {
        while (sent_ < last && sent_ - answered_ < in_flight) push();
        expect_answer();
    }
}

}  // namespace meniscus::soak
