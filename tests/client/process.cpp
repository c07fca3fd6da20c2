#include "process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "formats/bytes/byte_cursor.hpp"
#include "sample_files.hpp"

namespace meniscus::test {

ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments,
                          const Redirection& redirection) {
    const TemporaryDirectory directory;
    const std::string out = (directory / "out").string();
    const std::string err = (directory / "err").string();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), flags, 0600);
    if (redirection.out >= 0) posix_spawn_file_actions_adddup2(&actions, redirection.out, STDOUT_FILENO);
    if (!redirection.in.empty())
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, redirection.in.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), flags, 0600);
    if (redirection.err >= 0) posix_spawn_file_actions_adddup2(&actions, redirection.err, STDERR_FILENO);
    std::vector<std::string> copies{program};
    copies.insert(copies.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(copies.size() + 1);
    for (std::string& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    const int spawned = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (spawned != 0) throw std::runtime_error("cannot run " + program);
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, 0, &usage) != child) throw std::runtime_error("lost " + program);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, formats::read_file(out), formats::read_file(err),
            seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1000.0};
}

}  // namespace meniscus::test
