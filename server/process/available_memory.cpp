#include "process/available_memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

namespace meniscus::server {

namespace {

constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

std::uint64_t machine_memory() {
    const long pages = ::sysconf(_SC_PHYS_PAGES);
    const long page_bytes = ::sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page_bytes <= 0) return none;
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes);
}

/// "max" is no number.
std::uint64_t read_limit(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::uint64_t bytes = 0;
    return in >> bytes ? bytes : none;
}

/// The smallest limit of a group and of those that hold it.
std::uint64_t group_limit(const std::filesystem::path& hierarchy, std::filesystem::path group, const char* file) {
    std::uint64_t limit = read_limit(hierarchy / group / file);
    while (!group.empty()) {
        group = group.parent_path();
        limit = std::min(limit, read_limit(hierarchy / group / file));
    }
    return limit;
}

/// Lines of /proc/self/cgroup are NUMBER:CONTROLLERS:/PATH; version 2 is number 0 without controllers.
std::uint64_t control_group_limit(const std::filesystem::path& root) {
    const std::filesystem::path groups = root / "sys/fs/cgroup";
    std::uint64_t limit = none;
    std::ifstream in(root / "proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos || second + 1 == line.size()) continue;
        const std::string controllers =
            fmt::format(",{},", std::string_view(line).substr(first + 1, second - first - 1));
        const std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
        if (controllers == ",,")
            limit = std::min(limit, group_limit(groups, group, "memory.max"));
        else if (controllers.find(",memory,") != std::string::npos)
            limit = std::min(limit, group_limit(groups / "memory", group, "memory.limit_in_bytes"));
    }
    return limit;
}

}  // namespace

std::uint64_t available_memory(const std::filesystem::path& root) {
    const std::uint64_t bytes = std::min(machine_memory(), control_group_limit(root));
    return bytes == none ? 0 : bytes;
}

}  // namespace meniscus::server
