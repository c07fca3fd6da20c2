// The client of the C interface.
#pragma once

#include "meniscus/client/client.hpp"
#include "meniscus/meniscus.h"

struct meniscus_client {
    meniscus::client::Client content;
};
