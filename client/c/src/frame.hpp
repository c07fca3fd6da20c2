// A received frame of the C interface.
#pragma once

#include "meniscus/client/received_frame.hpp"
#include "meniscus/meniscus.h"

struct meniscus_frame {
    meniscus::client::ReceivedFrame content;
};
