#include "web/observation_pages.hpp"

#include <prometheus/text_serializer.h>

#include <utility>

namespace meniscus::server {

void add_observation_pages(Router& router, std::function<std::vector<prometheus::MetricFamily>()> collect,
                           std::function<bool()> ready) {
    router.add("/metrics", [collect = std::move(collect)] {
        return Page{.content_type = "text/plain; version=0.0.4; charset=utf-8",
                    .body = prometheus::TextSerializer().Serialize(collect())};
    });
    // That it is answered is the answer.
    router.add("/healthz", [] { return Page{.body = "alive\n"}; });
    router.add("/readyz", [ready = std::move(ready)] {
        return ready() ? Page{.body = "ready\n"} : Page{.status = 503, .body = "shutting down\n"};
    });
}

}  // namespace meniscus::server
