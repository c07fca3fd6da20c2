// The answers to the frames of a stream or a publisher, while another thread goes on pushing.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "meniscus/client/client.hpp"

namespace meniscus::cli {

/// Takes the answers, on a thread of its own, until the upload ends.
class StreamAnswers {
public:
    using Handler = std::function<void(const client::ReceivedFrame&)>;
    /// upload: a client::Stream or client::Publisher, which is borrowed. handle: called by that thread alone.
    /// after_failure: called by it, once, when the upload or `handle` has failed; further answers are only taken out of
    /// the way, so that a push() does not wait for ever.
    template <class Upload>
    StreamAnswers(Upload& upload, Handler handle, std::function<void()> after_failure = {})
        : next_([&upload] { return upload.next(); }),
          end_upload_([&upload] { upload.finish(); }),
          handle_(std::move(handle)),
          after_failure_(std::move(after_failure)),
          thread_([this] { take(); }) {}
    ~StreamAnswers();
    StreamAnswers(const StreamAnswers&) = delete;
    StreamAnswers& operator=(const StreamAnswers&) = delete;

    /// Waits for the answers to all frames. Throws the error that one of them met.
    void finish();

private:
    void take();

    std::function<std::optional<client::ReceivedFrame>()> next_;
    std::function<void()> end_upload_;
    Handler handle_;
    std::function<void()> after_failure_;
    std::exception_ptr error_;  ///< of the thread; read once that has ended
    std::thread thread_;
};

}  // namespace meniscus::cli
