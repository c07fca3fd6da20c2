// The viewer at "/", for any browser.
#pragma once

#include "web/router.hpp"

namespace meniscus::server {

void add_viewer_pages(Router& router);

}  // namespace meniscus::server
