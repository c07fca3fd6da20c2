#include "check/command.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace meniscus::benchmarks {
namespace {

std::atomic<bool> asked_to_end{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// Becomes the program. Between fork() and exec() only what may follow fork() in a process of several threads.
[[noreturn]] void become(char* const* words, char* const* environment, int log, const sigset_t& signals) {
    ::setpgid(0, 0);
    ::sigprocmask(SIG_SETMASK, &signals, nullptr);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::execve(words[0], words, environment);
    ::_exit(127);
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

std::vector<std::string> environment_of(const Command& command) {
    std::vector<std::string> all;
    for (const auto& [name, value] : command.environment) all.emplace_back(name).append("=").append(value);
    for (char** variable = environ; *variable != nullptr; ++variable) all.emplace_back(*variable);
    return all;  // of two with one name the first counts
}

std::string last_line_of(const std::string& path) {
    std::ifstream file(path);
    std::string last;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) last = line;
    return last;
}

/// Waits for the child to end, for a signal to this process if it counts, or until then. Returns whether the child has
/// ended.
bool wait_for_end(pid_t child, int& status, std::chrono::steady_clock::time_point until, const sigset_t& awaited,
                  bool signals_count) {
    for (;;) {
        if (::waitpid(child, &status, WNOHANG) == child) return true;
        const auto left = until - std::chrono::steady_clock::now();
        if ((signals_count && asked_to_end) || left.count() <= 0) return false;
        const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(left).count();
        const timespec most{static_cast<time_t>(nanoseconds / 1'000'000'000),
                            static_cast<long>(nanoseconds % 1'000'000'000)};
        const int signal = ::sigtimedwait(&awaited, nullptr, &most);
        if (signal > 0 && signal != SIGCHLD) asked_to_end = true;
    }
}

sigset_t awaited_signals() {
    sigset_t signals;
    ::sigemptyset(&signals);
    for (const int signal : {SIGCHLD, SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&signals, signal);
    return signals;
}

}  // namespace

void end_commands_on_signals() {
    const sigset_t signals = awaited_signals();
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

bool is_asked_to_end() {
    const sigset_t signals = awaited_signals();
    const timespec none{};
    for (int signal = 0; (signal = ::sigtimedwait(&signals, nullptr, &none)) > 0;)
        if (signal != SIGCHLD) asked_to_end = true;
    return asked_to_end;
}

CommandEnd run_command(const Command& command, const std::string& log, double seconds) {
    std::vector<std::string> words = command.words;
    std::vector<std::string> environment = environment_of(command);
    const std::vector<char*> word_pointers = pointers(words);
    const std::vector<char*> environment_pointers = pointers(environment);
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) throw std::runtime_error("cannot write " + log + ": " + std::strerror(errno));
    const sigset_t awaited = awaited_signals();
    sigset_t before;
    ::pthread_sigmask(SIG_BLOCK, &awaited, &before);
    sigset_t none;
    ::sigemptyset(&none);
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = ::fork();
    if (child == 0) become(word_pointers.data(), environment_pointers.data(), file, none);
    ::close(file);
    if (child < 0) throw std::runtime_error("cannot run " + words[0] + ": " + std::strerror(errno));
    CommandEnd end;
    int status = 0;
    const auto of_time =
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
    if (!wait_for_end(child, status, begin + of_time, awaited, command.ends_on_signals)) {
        end.is_cut_off = true;
        ::kill(-child, SIGKILL);
        ::waitpid(child, &status, 0);
    }
    ::kill(-child, SIGKILL);  // what it may have left behind
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    end.last_line = last_line_of(log);
    if (end.exit_code == 127 && end.last_line.empty()) end.last_line = "cannot run " + words[0];
    return end;
}

}  // namespace meniscus::benchmarks
