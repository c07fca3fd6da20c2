#include "web/observation_pages.hpp"

#include <prometheus/text_serializer.h>

#include <utility>

namespace meniscus::server {

void add_observation_pages(Router& router, std::function<std::vector<prometheus::MetricFamily>()> collect,
                           std::function<bool()> alive, std::function<bool()> ready) {
    router.add("/metrics", [collect = std::move(collect)] {
        return Page{.content_type = "text/plain; version=0.0.4; charset=utf-8",
                    .body = prometheus::TextSerializer().Serialize(collect())};
    });
    router.add("/healthz", [alive = std::move(alive)] {
        return alive() ? Page{.body = "alive\n"} : Page{.status = 503, .body = "the gRPC port does not answer\n"};
    });
    router.add("/readyz", [ready = std::move(ready)] {
        return ready() ? Page{.body = "ready\n"} : Page{.status = 503, .body = "shutting down\n"};
    });
}

}  // namespace meniscus::server
