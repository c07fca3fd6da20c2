#include "target.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace meniscus::hostile {

namespace {

/// The word after some words, up to a comma or the line's end; empty where the line has not got them.
std::string word_after(const std::string& line, const std::string& words) {
    const std::size_t found = line.find(words);
    if (found == std::string::npos) return {};
    const std::size_t first = found + words.size();
    return line.substr(first, line.find(',', first) - first);
}

}  // namespace

Target::Target(const std::string& program, TargetOptions options) {
    std::vector<std::string> command{program, "--listen", options.listen, "--http", "127.0.0.1:0"};
    command.insert(command.end(), options.arguments.begin(), options.arguments.end());
    std::vector<char*> argv;
    argv.reserve(command.size() + 1);
    for (std::string& word : command) argv.push_back(word.data());
    argv.push_back(nullptr);

    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe for the server's output");
    process_ = ::fork();
    if (process_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (options.descriptors) {
            const rlimit limit{*options.descriptors, *options.descriptors};
            ::setrlimit(RLIMIT_NOFILE, &limit);
        }
        ::dup2(ends[1], STDOUT_FILENO);
        ::dup2(ends[1], STDERR_FILENO);
        ::execv(argv.front(), argv.data());
        ::dprintf(STDERR_FILENO, "cannot run %s: %s\n", argv.front(), std::strerror(errno));
        ::_exit(127);
    }
    ::close(ends[1]);
    output_ = ends[0];
    if (process_ < 0) throw std::runtime_error("no process for the server");
    wait_until_it_listens();
    reader_ = std::thread([this] {
        char bytes[4096];
        while (::read(output_, bytes, sizeof bytes) > 0) {
        }
    });
}

Target::~Target() {
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    if (reader_.joinable()) reader_.join();
    ::close(output_);
}

std::size_t Target::peak_bytes() const {
    std::ifstream status("/proc/" + std::to_string(process_) + "/status");
    std::string word;
    std::size_t kibibytes = 0;
    while (status >> word && word != "VmHWM:") {
    }
    if (!(status >> kibibytes)) throw std::runtime_error("the server has ended");
    return kibibytes * 1024;
}

double Target::processor_seconds() const {
    clockid_t clock{};
    timespec time{};
    if (::clock_getcpuclockid(process_, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
        throw std::runtime_error("the server has ended");
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

End Target::terminate() {
    const auto begin = std::chrono::steady_clock::now();
    ::kill(process_, SIGTERM);
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    return {time.count(), WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
}

void Target::wait_until_it_listens() {
    std::string said;
    while (address_.empty() || http_address_.empty()) {
        const std::optional<std::string> next = line();
        if (!next) {
            ::waitpid(std::exchange(process_, -1), nullptr, 0);
            throw std::runtime_error("the server does not listen:\n" + said);
        }
        said += *next + '\n';
        if (address_.empty()) address_ = word_after(*next, "listening on ");
        if (http_address_.empty()) http_address_ = word_after(*next, "metrics and probes at http://");
    }
}

std::optional<std::string> Target::line() {
    for (;;) {
        if (const std::size_t end = buffer_.find('\n'); end != std::string::npos) {
            std::string text = buffer_.substr(0, end);
            buffer_.erase(0, end + 1);
            return text;
        }
        char bytes[4096];
        const ssize_t count = ::read(output_, bytes, sizeof bytes);
        if (count <= 0) return std::nullopt;
        buffer_.append(bytes, static_cast<std::size_t>(count));
    }
}

}  // namespace meniscus::hostile
