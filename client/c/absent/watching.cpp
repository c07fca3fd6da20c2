// Watchers, and what else is of sessions of others, in a build without the service: `meniscus push` has no such thing.
#include "absent_function.hpp"

using namespace meniscus::c;

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
