// The functions that need a server, in a build without the service.
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

meniscus_result meniscus_client_connect(const char* /*address*/, const meniscus_options* /*options*/,
                                        meniscus_client** client) {
    return absent(__func__, client);
}
void meniscus_client_destroy(meniscus_client* /*client*/) {}
meniscus_result meniscus_client_delete_session(meniscus_client* /*client*/, const char* /*session_id*/) {
    return absent(__func__);
}

meniscus_result meniscus_session_open(meniscus_client* /*client*/, const meniscus_options* /*options*/,
                                      meniscus_session** session) {
    return absent(__func__, session);
}
void meniscus_session_destroy(meniscus_session* /*session*/) {}
meniscus_result meniscus_session_leave(meniscus_session* /*session*/) {
    return absent(__func__);
}
const char* meniscus_session_id(const meniscus_session* /*session*/) {
    return nullptr;
}
meniscus_result meniscus_session_push(meniscus_session* /*session*/, const meniscus_particles* /*particles*/,
                                      uint64_t /*index*/, double /*simulation_time*/) {
    return absent(__func__);
}
meniscus_result meniscus_session_try_push(meniscus_session* /*session*/, const meniscus_particles* /*particles*/,
                                          uint64_t /*index*/, double /*simulation_time*/) {
    return absent(__func__);
}
meniscus_result meniscus_session_finish(meniscus_session* /*session*/) {
    return absent(__func__);
}
meniscus_result meniscus_session_next(meniscus_session* /*session*/, double /*timeout_seconds*/,
                                      meniscus_frame** frame) {
    return absent(__func__, frame);
}
meniscus_result meniscus_session_cancel(meniscus_session* /*session*/) {
    return absent(__func__);
}
meniscus_result meniscus_session_dropped(const meniscus_session* /*session*/, uint64_t* /*frames*/) {
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

void meniscus_frame_destroy(meniscus_frame* /*frame*/) {}
meniscus_result meniscus_frame_index(const meniscus_frame* /*frame*/, uint64_t* /*index*/) {
    return absent(__func__);
}
meniscus_result meniscus_frame_simulation_time(const meniscus_frame* /*frame*/, double* /*seconds*/) {
    return absent(__func__);
}
meniscus_result meniscus_frame_mesh(const meniscus_frame* /*frame*/, meniscus_mesh* /*mesh*/) {
    return absent(__func__);
}
meniscus_result meniscus_frame_statistics(const meniscus_frame* /*frame*/, meniscus_statistics* /*statistics*/) {
    return absent(__func__);
}
