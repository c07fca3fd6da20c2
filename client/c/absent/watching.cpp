// Watchers, and what else is of sessions of others, in a build without the service: `meniscus push` has no such thing.
#include "../src/result.hpp"
#include "meniscus/error.hpp"
#include "meniscus/meniscus.h"

using namespace meniscus::c;

namespace {

meniscus_result absent(const char* function) {
    return guarded([function]() -> meniscus_result {
        throw meniscus::NotBuilt(function,
                                 "the service: build it without -DMENISCUS_SERVICE=OFF, where gRPC is installed");
    });
}

/// A function that would give an object.
template <class Object>
meniscus_result absent(const char* function, Object** object) {
    if (object != nullptr) *object = nullptr;
    return absent(function);
}

}  // namespace

meniscus_result meniscus_client_delete_session(meniscus_client* /*client*/, const char* /*session_id*/) {
    return absent(__func__);
}

meniscus_result meniscus_watcher_open(meniscus_client* /*client*/, const char* /*session_id*/,
                                      const meniscus_options* /*options*/, meniscus_watcher** watcher) {
    return absent(__func__, watcher);
}
void meniscus_watcher_destroy(meniscus_watcher* /*watcher*/) {}
meniscus_result meniscus_watcher_next(meniscus_watcher* /*watcher*/, double /*timeout_seconds*/,
                                      meniscus_frame** frame) {
    return absent(__func__, frame);
}
meniscus_result meniscus_watcher_cancel(meniscus_watcher* /*watcher*/) {
    return absent(__func__);
}
