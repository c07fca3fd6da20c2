#include "through_push.hpp"

#include "../src/frame.hpp"
#include "../src/result.hpp"
#include "../src/timeout.hpp"
#include "meniscus/error.hpp"
#include "pushing/push_answer.hpp"

namespace meniscus::c {

meniscus_result next_answer(pushing::PushedUpload& upload, double timeout_seconds, meniscus_frame** frame) {
    required(frame, "frame") = nullptr;
    const pushing::PushProcess::Answer answer = upload.process().next(timeout_of(timeout_seconds));
    if (!answer.line) return answer.ended ? MENISCUS_ENDED : MENISCUS_NOTHING_YET;
    *frame = new meniscus_frame{pushing::read_answer(*answer.line)};
    return MENISCUS_OK;
}

void not_through_push(const std::string& what, const std::string& remedy) {
    throw NotBuilt(what, "the service, and meniscus push cannot do it: " + remedy);
}

}  // namespace meniscus::c
