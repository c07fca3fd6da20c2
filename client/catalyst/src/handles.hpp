// Handles of the C interface that are destroyed with their owners.
#pragma once

#include <memory>

#include "meniscus/meniscus.h"

namespace meniscus::catalyst {

template <class Handle, void (*destroy)(Handle*)>
struct Destroyer {
    void operator()(Handle* handle) const { destroy(handle); }
};
using Session = std::unique_ptr<meniscus_session, Destroyer<meniscus_session, meniscus_session_destroy>>;
using Client = std::unique_ptr<meniscus_client, Destroyer<meniscus_client, meniscus_client_destroy>>;
using COptions = std::unique_ptr<meniscus_options, Destroyer<meniscus_options, meniscus_options_destroy>>;

}  // namespace meniscus::catalyst
