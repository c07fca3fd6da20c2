#include "metrics/process_metrics.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "metrics/gauge_family.hpp"

namespace meniscus::server {

namespace {

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

}  // namespace

std::vector<prometheus::MetricFamily> process_metrics() {
    std::vector<prometheus::MetricFamily> families;
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) == 0)
        families.push_back(counter("process_cpu_seconds_total", "User and system time of the process.",
                                   seconds(usage.ru_utime) + seconds(usage.ru_stime)));
    double pages = 0;
    double resident_pages = 0;
    if (std::ifstream("/proc/self/statm") >> pages >> resident_pages)
        families.push_back(gauge("process_resident_memory_bytes", "Memory of the process that is in RAM.",
                                 resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE))));
    std::error_code error;
    const auto descriptors = std::filesystem::directory_iterator("/proc/self/fd", error);
    if (!error)
        families.push_back(gauge("process_open_fds", "File descriptors open.",
                                 static_cast<double>(std::distance(begin(descriptors), end(descriptors)))));
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0)
        families.push_back(gauge("process_max_fds", "File descriptors that the process may open.",
                                 static_cast<double>(limit.rlim_cur)));
    return families;
}

}  // namespace meniscus::server
