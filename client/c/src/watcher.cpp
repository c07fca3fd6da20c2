#include <utility>

#include "attribute_options.hpp"
#include "client.hpp"
#include "next_frame.hpp"
#include "options.hpp"
#include "result.hpp"

using namespace meniscus::c;

struct meniscus_watcher {
    meniscus::client::Watcher content;
};

meniscus_result meniscus_watcher_open(meniscus_client* client, const char* session_id, const meniscus_options* options,
                                      meniscus_watcher** watcher) {
    return guarded([&] {
        required(watcher, "watcher") = nullptr;
        OptionReader reader(options);
        meniscus::client::WatchOptions wishes;
        reader.read("max-level", wishes.max_level);
        reader.read("normal-bits", wishes.normal_bits);
        reader.read("position-bits", wishes.position_bits);
        reader.read("region", wishes.region);
        reader.read("spray", wishes.spray);
        reader.read("bytes-per-second", wishes.bytes_per_second);
        reader.read("viewpoint", wishes.viewpoint);
        reader.read("reconnect", wishes.reconnect);
        wishes.attributes = read_attribute_wishes(reader);
        reader.finish();
        *watcher =
            new meniscus_watcher{required(client, "client").content.watch(&required(session_id, "session_id"), wishes)};
        return MENISCUS_OK;
    });
}

void meniscus_watcher_destroy(meniscus_watcher* watcher) {
    delete watcher;
}

meniscus_result meniscus_watcher_next(meniscus_watcher* watcher, double timeout_seconds, meniscus_frame** frame) {
    return guarded([&] { return next_frame(required(watcher, "watcher").content, timeout_seconds, frame); });
}

meniscus_result meniscus_watcher_cancel(meniscus_watcher* watcher) {
    return guarded([&] {
        required(watcher, "watcher").content.cancel();
        return MENISCUS_OK;
    });
}
