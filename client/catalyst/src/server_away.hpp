// Which errors are those of a server that may be there again.
#pragma once

#include "meniscus/meniscus.h"

namespace meniscus::catalyst {

/// Whether an error is that of a server, or of a session, that may be there again later.
constexpr bool is_away(meniscus_result result) {
    switch (result) {
        case MENISCUS_UNAVAILABLE:
        case MENISCUS_DEADLINE_EXCEEDED:
        case MENISCUS_CANCELED:
        case MENISCUS_ABORTED:
        case MENISCUS_NOT_FOUND:
            return true;
        default:
            return false;
    }
}

}  // namespace meniscus::catalyst
