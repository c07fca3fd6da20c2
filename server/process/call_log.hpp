// Lines about calls that are taken, and about sessions: clients can cause as many as they like.
#pragma once

#include <fmt/format.h>

#include <utility>

#include "process/line_limit.hpp"
#include "process/log.hpp"

namespace meniscus::server {

/// Logs 3000 lines in ten seconds at the most, all clients together; the next line then has the number of those left
/// out. That is room for 200 sessions that come and go within ten seconds, each with three streams and three watchers,
/// and less than journald keeps of one service. Thread-safe.
class CallLog {
public:
    template <class... Args>
    void write(const LogSubject& subject, fmt::format_string<Args...> text, Args&&... args) {
        if (const auto kept_back = lines_.pass())
            log_info(subject, "{}{}", fmt::format(text, std::forward<Args>(args)...), left_out(*kept_back));
    }

private:
    LineLimit lines_{3000};
};

/// The process's, as the log is.
inline CallLog call_log;

}  // namespace meniscus::server
