#include "web/observation_pages.hpp"

#include <prometheus/text_serializer.h>

#include <utility>

namespace meniscus::server {

void add_observation_pages(Router& router, std::function<std::vector<prometheus::MetricFamily>()> collect,
                           const std::function<bool()>& alive, std::function<bool()> ready) {
    router.add("/metrics", [collect = std::move(collect)] {
        return Page{.content_type = "text/plain; version=0.0.4; charset=utf-8",
                    .body = prometheus::TextSerializer().Serialize(collect())};
    });
    const Page dead{.status = 503, .body = "the gRPC port does not answer\n"};
    router.add("/healthz", [alive, dead] { return alive() ? Page{.body = "alive\n"} : dead; });
    router.add("/readyz", [alive, dead, ready = std::move(ready)] {
        if (!alive()) return Page(dead);
        return ready() ? Page{.body = "ready\n"} : Page{.status = 503, .body = "shutting down\n"};
    });
}

}  // namespace meniscus::server
