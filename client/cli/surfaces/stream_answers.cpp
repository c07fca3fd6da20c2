#include "cli/surfaces/stream_answers.hpp"

namespace meniscus::cli {

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
        end_upload_();
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
        while (const auto frame = next_()) {
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
