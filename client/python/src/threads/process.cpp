#include "threads/process.hpp"

#include <unistd.h>

#include <atomic>

namespace meniscus::python {
namespace {

std::atomic<pid_t> used_in = 0;  // 0: not used yet

}  // namespace

ForkedError::ForkedError()
    : std::runtime_error(
          "this process was forked after it had used meniscus, whose threads do not survive that: start processes by "
          "\"spawn\" or \"forkserver\" (multiprocessing.set_start_method), or fork before the first use") {}

void require_own_process() {
    pid_t none = 0;
    const pid_t own = getpid();
    if (!used_in.compare_exchange_strong(none, own) && none != own) throw ForkedError();
}

bool is_forked() noexcept {
    const pid_t owner = used_in.load();
    return owner != 0 && owner != getpid();
}

}  // namespace meniscus::python
