// Publishers in a build without the service: `meniscus push` takes particles.
#include "absent_function.hpp"

using namespace meniscus::c;

meniscus_result meniscus_publisher_open(meniscus_client* /*client*/, const meniscus_options* /*options*/,
                                        meniscus_publisher** publisher) {
    return absent(__func__, publisher);
}
void meniscus_publisher_destroy(meniscus_publisher* /*publisher*/) {}
meniscus_result meniscus_publisher_leave(meniscus_publisher* /*publisher*/) {
    return absent(__func__);
}
const char* meniscus_publisher_session_id(const meniscus_publisher* /*publisher*/) {
    return nullptr;
}
meniscus_result meniscus_publisher_push(meniscus_publisher* /*publisher*/, const meniscus_mesh* /*mesh*/,
                                        uint64_t /*index*/, double /*simulation_time*/) {
    return absent(__func__);
}
meniscus_result meniscus_publisher_finish(meniscus_publisher* /*publisher*/) {
    return absent(__func__);
}
meniscus_result meniscus_publisher_next(meniscus_publisher* /*publisher*/, double /*timeout_seconds*/,
                                        meniscus_frame** frame) {
    return absent(__func__, frame);
}
meniscus_result meniscus_publisher_cancel(meniscus_publisher* /*publisher*/) {
    return absent(__func__);
}
meniscus_result meniscus_publisher_dropped(const meniscus_publisher* /*publisher*/, uint64_t* /*frames*/) {
    return absent(__func__);
}
