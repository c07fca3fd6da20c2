#include <utility>

#include "client.hpp"
#include "next_frame.hpp"
#include "options.hpp"
#include "result.hpp"
#include "text_options/client_options.hpp"

using namespace meniscus::c;

struct meniscus_watcher {
    meniscus::client::Watcher content;
};

meniscus_result meniscus_watcher_open(meniscus_client* client, const char* session_id, const meniscus_options* options,
                                      meniscus_watcher** watcher) {
    return guarded([&] {
        required(watcher, "watcher") = nullptr;
        auto reader = reader_of(options);
        const auto request = meniscus::text_options::read_watch(reader);
        reader.finish();
        *watcher = new meniscus_watcher{
            required(client, "client").content.watch(&required(session_id, "session_id"), request)};
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
