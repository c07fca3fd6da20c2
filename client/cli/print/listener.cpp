#include "cli/print/listener.hpp"

#include <poll.h>
#include <unistd.h>

#include <stdexcept>

namespace meniscus::cli {

void require_listener() {
    pollfd error{.fd = STDERR_FILENO, .events = 0, .revents = 0};
    if (::poll(&error, 1, 0) == 1 && (error.revents & POLLERR) != 0)
        throw std::runtime_error("standard error: nobody reads it any more");
}

}  // namespace meniscus::cli
