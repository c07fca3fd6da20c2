// spdlog makes its registry when it is first asked for it. Debian's is not compiled for the thread sanitizer, which
// would take that for a race with every thread that logs, so it is made before there are threads.
#include <spdlog/spdlog.h>

namespace {

[[maybe_unused]] const spdlog::logger* const made_first = spdlog::default_logger_raw();

}  // namespace
