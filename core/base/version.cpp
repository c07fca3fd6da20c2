// Alone in its file, so that another version compiles nothing else anew.
#include "meniscus/reconstructor.hpp"

namespace meniscus {

std::string_view version() {
    return MENISCUS_VERSION;
}

}  // namespace meniscus
