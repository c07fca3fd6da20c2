// meniscus-fuzz-mutations COUNT [TARGET...]: COUNT damaged inputs for each target, or for all of them. Ends itself at
// the first that breaks one, which then lies in broken-TARGET. One target in one process: run several side by side.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <string>

#include "mutation.hpp"
#include "targets.hpp"

namespace {

using meniscus::fuzz::Target;

/// The input in work and the name of a file: the signal handler writes the input there at a crash.
std::string current;
std::string current_name;

void keep_input(int signal) {
    const int file = ::open(current_name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file >= 0) {
        [[maybe_unused]] const auto written = ::write(file, current.data(), current.size());
        ::close(file);
    }
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

/// Bytes that the process may take: more than any input justifies.
constexpr rlim_t most_memory = rlim_t{4} << 30;
/// Seconds that one input may take: thousands of times what any does.
constexpr unsigned most_seconds = 20;

void run(const Target& target, std::uint64_t count) {
    std::mt19937 random(1);
    const auto seeds = target.seeds();
    current_name = std::string("broken-") + target.name;
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t i = 0; i < count; ++i) {
        current = meniscus::fuzz::mutated(seeds, random);
        ::alarm(most_seconds);
        target.run(current);
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    std::printf("%-18s %10llu inputs %8.1f s %6ld MB at most\n", target.name, static_cast<unsigned long long>(count),
                seconds.count(), usage.ru_maxrss / 1024);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::uint64_t count = 0;
    const char* end = argc < 2 ? nullptr : argv[1] + std::strlen(argv[1]);
    if (argc < 2 || std::from_chars(argv[1], end, count).ptr != end || count == 0) {
        std::fputs("usage: meniscus-fuzz-mutations COUNT [TARGET...]\n", stderr);
        return 2;
    }
// Sanitizers, which clang is taken for, map more than any limit allows.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
    const rlimit memory{most_memory, most_memory};
    ::setrlimit(RLIMIT_AS, &memory);
#endif
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGALRM}) std::signal(signal, keep_input);
    int runs = 0;
    for (const Target& target : meniscus::fuzz::targets()) {
        bool wanted = argc == 2;
        for (int i = 2; i < argc; ++i) wanted = wanted || std::string_view(argv[i]) == target.name;
        if (!wanted) continue;
        run(target, count);
        ++runs;
    }
    if (runs == 0 || (argc > 2 && runs != argc - 2)) {
        std::fputs("meniscus-fuzz-mutations: no such target\n", stderr);
        return 2;
    }
    return 0;
}
