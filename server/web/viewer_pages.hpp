// The viewer at "/", for any browser.
#pragma once

#include "web/frame_ancestors.hpp"
#include "web/router.hpp"

namespace meniscus::server {

/// ancestors: the pages that may show it in a frame.
void add_viewer_pages(Router& router, const FrameAncestors& ancestors = {});

}  // namespace meniscus::server
