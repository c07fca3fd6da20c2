// Where proxies spread sessions over several servers: whether a stream is still where its session belongs.
#include <chrono>
#include <string>

#include "call_end.hpp"
#include "session_look.hpp"
#include "stream_impl.hpp"

namespace meniscus::client {

namespace {

/// A server that the session is to leave, and that answers nothing for this time, is given up. Long enough for a large
/// frame on a busy server: watchers there would not hear of the move.
constexpr std::chrono::seconds leaving_time{60};

}  // namespace

void Stream::Impl::check_route() {
    std::unique_lock lock(mutex_);
    while (!over_.wait_for(lock, options_.route_check, [&] { return left_ || ended_; })) {
        if (moving_ && call_ && Clock::now() - moving_since_ > leaving_time) call_->cancel();
        if (moving_ || !call_ || half_closed_ || instance_.empty()) continue;
        const std::shared_ptr<UploadCall> call = call_;
        const std::string instance = instance_;
        for (auto& context : route_calls_) context = std::make_shared<grpc::ClientContext>();
        const auto [looking, creating] = route_calls_;
        lock.unlock();
        const bool elsewhere = is_elsewhere(instance, *looking, *creating);
        lock.lock();
        if (!elsewhere || call_ != call || half_closed_) continue;
        moving_ = true;
        moving_since_ = Clock::now();
        changed_.notify_all();
    }
}

bool Stream::Impl::is_elsewhere(const std::string& instance, grpc::ClientContext& looking,
                                grpc::ClientContext& creating) const {
    const auto give_up_at = Clock::now() + options_.reconnect;
    wait_for_connection(looking, give_up_at);
    v1::Session session;
    const grpc::Status status = get_session(*connection_, looking, session_.id(), session);
    const std::string other = ended_by(looking);
    if (other.empty() || other == instance) return false;
    // A session that somebody uploads to is theirs.
    if (status.ok() ? session.uploading() : status.error_code() != grpc::StatusCode::NOT_FOUND) return false;
    // Only a server that has room for the session is worth giving up the stream.
    return create_session(creating, give_up_at).ok() && ended_by(creating) != instance;
}

}  // namespace meniscus::client
