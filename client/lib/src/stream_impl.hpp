// The inside of a Stream.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "backoff.hpp"
#include "byte_pool.hpp"
#include "connection/connection.hpp"
#include "made_sessions.hpp"
#include "meniscus/client/client.hpp"
#include "named_arrays.hpp"
#include "particle_buffer_memory.hpp"
#include "pushed_frame.hpp"
#include "upload_call.hpp"

namespace meniscus::client {

/// Threads of its own: one sends the frames that were pushed, one receives their answers and, when the call breaks,
/// opens the next one, over which all that is unanswered is sent again. One that resumes has a third: it looks where
/// the session belongs.
class Stream::Impl {
public:
    enum class Uploads { particles, bricks };

    /// made: gets each session that this creates again; may be none.
    /// named: by the session's settings, where they are known.
    static std::shared_ptr<Impl> open(std::shared_ptr<Connection> connection, const std::string& session_id,
                                      const StreamOptions& options, Uploads uploads = Uploads::particles,
                                      std::shared_ptr<MadeSessions> made = nullptr, NamedArrays named = {});
    Impl(std::shared_ptr<Connection> connection, const std::string& session_id, const StreamOptions& options,
         Uploads uploads, std::shared_ptr<MadeSessions> made, NamedArrays named);
    ~Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    enum class WhenFull { wait, give_up };

    /// make: the frame, from the pool, with those of its arrays that are named; called when there is room for it.
    /// Returns whether there was.
    template <class Make>
    bool push(std::uint64_t index, WhenFull when_full, bool has_arrays, Make make) {
        if (!wait_for_room(index, when_full)) return false;
        if (has_arrays && when_full == WhenFull::wait && !named_.are_known() && !std::exchange(looked_for_names_, true))
            look_for_names();
        enqueue(std::make_shared<PushedFrame>(make(*pool_, named_)));
        return true;
    }
    ParticleBuffer next_buffer(std::size_t particles, bool with_levels, std::span<const ArrayForm> arrays) {
        return ParticleBufferMemory::pooled(*pool_, particles, with_levels ? particles : 0, arrays);
    }
    void finish();
    /// until: none to wait as long as it takes.
    Next<ReceivedFrame> next(std::optional<std::chrono::steady_clock::time_point> until);
    void cancel();
    std::uint64_t dropped() const;
    /// Cancels, and ends the threads. gRPC holds up one that writes to a server that reads nothing any more, although
    /// the call is canceled: it is left to itself, and keeps this object until the connection ends. None of them calls
    /// on_reconnect afterwards, which may refer to what goes with the caller.
    void leave() noexcept;

private:
    using Clock = std::chrono::steady_clock;

    bool wait_for_room(std::uint64_t index, WhenFull when_full);
    /// Asks the server for the session's settings. Where it does not answer, they stay unknown.
    void look_for_names();
    void enqueue(std::shared_ptr<PushedFrame> frame);
    void start(const std::shared_ptr<Impl>& self);
    /// A thread that runs this object's work.
    template <class Work>
    std::thread run(const std::shared_ptr<Impl>& self, Work work);

    /// again: whether it goes on where one before has broken off.
    std::shared_ptr<UploadCall> open_call(bool again) const;
    bool resumes() const { return options_.reconnect.count() > 0; }

    // The sending thread.
    void send();
    /// Whether a frame, or that none will follow, can be sent. With the lock held.
    bool may_send() const;

    // The receiving thread.
    void receive(std::shared_ptr<UploadCall> call);
    /// Returns with what the call ended. Throws ServerError for answers that make no sense.
    grpc::Status read_answers(UploadCall& call);
    void take(ReceivedFrame frame);
    void take(const v1::FrameDropped& dropped);
    /// Forgets the frame, which has been answered. False if it was answered before. With the lock held.
    bool settle(std::uint64_t index);
    bool is_worth_another_call(const grpc::Status& status, const UploadCall& call) const;
    /// After a call that the server has ended because nothing came: until there is a frame to send. False if none will
    /// come. Throws the status where the stream does not resume.
    bool wait_for_use(const grpc::Status& status);
    /// The next call. None once the stream is left. Throws what becomes of the stream without another call.
    std::shared_ptr<UploadCall> reopen(grpc::Status status);
    grpc::Status create_session(grpc::ClientContext& context, Clock::time_point give_up_at) const;
    void end(std::exception_ptr error);
    /// Calls on_reconnect about an attempt, unless the stream was left.
    void report(bool connected, Clock::time_point give_up_at);

    // The thread that looks.
    void check_route();
    /// Whether another server than this instance answers for the session, and has it now, free for this stream.
    bool is_elsewhere(const std::string& instance, grpc::ClientContext& looking, grpc::ClientContext& creating) const;

    const std::shared_ptr<Connection> connection_;
    const StreamOptions options_;
    const std::shared_ptr<MadeSessions> made_;
    const std::shared_ptr<BytePool> pool_ = std::make_shared<BytePool>();
    const std::string session_id_;
    UploadOpening opening_;
    v1::CreateSessionRequest session_;  ///< for a server that has lost it

    // The following belong to the thread that pushes.
    NamedArrays named_;
    bool looked_for_names_ = false;

    // The following belong to the receiving thread.
    Backoff backoff_;
    std::optional<Clock::time_point>
        broken_at_;              ///< none: answers have come since, or a call was accepted when none were owed
    unsigned attempts_ = 0;      ///< to open another call since then
    bool connecting_ = false;    ///< the call is such another one, and not yet accepted
    std::string broken_reason_;  ///< or why the attempt before was in vain
    std::string created_by_;     ///< the instance of the server that had the session last; or empty

    mutable std::mutex mutex_;  ///< for what follows
    std::condition_variable changed_;
    std::shared_ptr<UploadCall> call_;                                 ///< none while it is broken
    std::string instance_;                                             ///< of the server that has accepted it; or empty
    std::shared_ptr<grpc::ClientContext> creating_;                    ///< of the call that creates the session again
    std::shared_ptr<grpc::ClientContext> looking_;                     ///< of that which asks for its settings
    std::array<std::shared_ptr<grpc::ClientContext>, 2> route_calls_;  ///< of the look under way
    std::deque<std::shared_ptr<PushedFrame>> unanswered_;
    std::size_t sent_ = 0;                        ///< of those, on this call
    std::optional<std::uint64_t> last_answered_;  ///< index
    bool finished_ = false;                       ///< no more frames will be pushed
    bool half_closed_ = false;                    ///< the server knows
    bool draining_ = false;                       ///< the server takes no more over this call
    bool moving_ = false;                         ///< the session goes on elsewhere: after the frame on its way
    Clock::time_point moving_since_;              ///< or since the last answer after that
    std::deque<ReceivedFrame> waiting_;
    std::vector<DroppedFrame> dropped_since_;  ///< the frame received last
    std::uint64_t dropped_ = 0;
    std::size_t outstanding_ = 0;  ///< frames pushed and neither returned by next() nor dropped
    bool left_ = false;            ///< by the caller
    bool ended_ = false;           ///< the server has answered all it will
    std::exception_ptr error_;
    std::condition_variable over_;     ///< left_ or ended_
    int running_ = 0;                  ///< threads
    bool reporting_ = false;           ///< on_reconnect is being called
    std::condition_variable stopped_;  ///< a thread, or on_reconnect

    std::vector<std::thread> threads_;
    std::optional<std::stop_callback<std::function<void()>>> on_stop_;
};

}  // namespace meniscus::client
