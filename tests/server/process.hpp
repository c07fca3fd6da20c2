// The program meniscusd, run by a test.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server::test {

/// meniscusd in a process of its own; what it prints is read here.
class Process {
public:
    /// descriptors: the most that it may have, soft and hard limit; 0: as many as the test.
    explicit Process(std::vector<std::string> arguments, rlim_t descriptors = 0) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
        arguments.insert(arguments.begin(), MENISCUSD_PATH);
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ == 0) {
            const rlimit limit{.rlim_cur = descriptors, .rlim_max = descriptors};
            if (descriptors != 0) ::setrlimit(RLIMIT_NOFILE, &limit);
            ::dup2(ends[1], STDOUT_FILENO);
            ::dup2(ends[1], STDERR_FILENO);
            ::execv(MENISCUSD_PATH, argv.data());
            ::_exit(127);
        }
        ::close(ends[1]);
        output_ = ends[0];
    }
    ~Process() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        ::close(output_);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// None at the end of the output.
    std::optional<std::string> line() {
        std::string text;
        char c = 0;
        while (::read(output_, &c, 1) == 1) {
            if (c == '\n') return text;
            text += c;
        }
        return std::nullopt;
    }
    std::string rest() {
        std::string text;
        while (const auto next = line()) text += *next + '\n';
        return text;
    }
    /// From the line that says so.
    std::string address() { return after("listening on "); }
    /// Likewise; after address().
    std::string http_address() { return after("metrics and probes at http://"); }
    /// The id in the line that says that a session was created; after address().
    std::string created_session() {
        constexpr std::string_view before = "session ";
        while (const auto next = line()) {
            const std::size_t found = next->find(before);
            const std::size_t end = next->find(": created on ");
            if (found == std::string::npos || end == std::string::npos) continue;
            return next->substr(found + before.size(), end - found - before.size());
        }
        throw std::runtime_error("meniscusd has created no session");
    }
    pid_t pid() const noexcept { return pid_; }
    void signal(int number) const { ::kill(pid_, number); }
    /// Until SIGCONT. Returns once all threads stand still, which they may not do yet when the signal has been sent.
    void stop() const {
        signal(SIGSTOP);
        ::waitpid(pid_, nullptr, WUNTRACED);
    }
    /// Waits for the process to end, and returns its exit code.
    int exit_code() {
        int status = 0;
        ::waitpid(std::exchange(pid_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

private:
    /// The word up to a comma or the line's end.
    std::string after(const std::string& words) {
        while (const auto next = line()) {
            const std::size_t found = next->find(words);
            if (found == std::string::npos) continue;
            const std::size_t first = found + words.size();
            return next->substr(first, next->find(',', first) - first);
        }
        throw std::runtime_error("meniscusd does not listen");
    }

    pid_t pid_ = -1;
    int output_ = -1;
};

inline std::vector<std::string> on_free_port(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"--listen", "127.0.0.1:0", "--threads", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

}  // namespace meniscus::server::test
