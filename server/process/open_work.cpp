#include "process/open_work.hpp"

namespace meniscus::server {

OpenWork& open_work() {
    static OpenWork work;
    return work;
}

}  // namespace meniscus::server
