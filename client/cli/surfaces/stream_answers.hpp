// The answers to a stream's frames, while another thread goes on pushing.
#pragma once

#include <exception>
#include <functional>
#include <thread>

#include "meniscus/client/client.hpp"

namespace meniscus::cli {

/// Takes a stream's answers, on a thread of its own, until the stream ends.
class StreamAnswers {
public:
    using Handler = std::function<void(const client::ReceivedFrame&)>;
    /// handle: called by that thread alone. after_failure: called by it, once, when the stream or `handle` has failed;
    /// further answers are only taken out of the way, so that a push() does not wait for ever.
    StreamAnswers(client::Stream& stream, Handler handle, std::function<void()> after_failure = {});
    ~StreamAnswers();
    StreamAnswers(const StreamAnswers&) = delete;
    StreamAnswers& operator=(const StreamAnswers&) = delete;

    /// Waits for the answers to all frames. Throws the error that one of them met.
    void finish();

private:
    void take();

    client::Stream& stream_;
    Handler handle_;
    std::function<void()> after_failure_;
    std::exception_ptr error_;  ///< of the thread; read once that has ended
    std::thread thread_;
};

}  // namespace meniscus::cli
