#include "cli/surfaces/stream_answers.hpp"

#include <utility>

namespace meniscus::cli {

StreamAnswers::StreamAnswers(client::Stream& stream, Handler handle, std::function<void()> after_failure)
    : stream_(stream),
      handle_(std::move(handle)),
      after_failure_(std::move(after_failure)),
      thread_([this] { take(); }) {}

StreamAnswers::~StreamAnswers() {
    if (!thread_.joinable()) return;
    // On the way out because of an earlier error, which is the one to report.
    try {
        finish();
    } catch (const std::exception&) {
    }
}

void StreamAnswers::finish() {
    std::exception_ptr error;
    try {
        stream_.finish();
    } catch (...) {
        error = std::current_exception();
    }
    thread_.join();
    if (error_) std::rethrow_exception(error_);
    if (error) std::rethrow_exception(error);
}

void StreamAnswers::take() {
    const auto keep_error = [this] {
        if (error_) return;
        error_ = std::current_exception();
        if (after_failure_) after_failure_();
    };
    try {
        while (const auto frame = stream_.next()) {
            if (error_) continue;
            try {
                handle_(*frame);
            } catch (...) {
                keep_error();
            }
        }
    } catch (...) {
        keep_error();
    }
}

}  // namespace meniscus::cli
