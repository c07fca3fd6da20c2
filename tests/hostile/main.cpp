// meniscus-hostile: attacks servers that it starts, and prints a verdict for each figure.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "attacks.hpp"

namespace {

using namespace meniscus::hostile;

constexpr unsigned most_seconds = 600;  ///< time limit of one attack

/// Prints a line for each figure. Whether all hold.
bool report(const Attack& attack, const std::vector<Figure>& figures) {
    bool all = !figures.empty();
    for (const Figure& figure : figures) {
        std::printf("%-7s %-24s %12.6g %-4s of at most %-10.6g %s\n", figure.holds() ? "held" : "BROKEN",
                    std::string(attack.name).c_str(), figure.value, figure.unit.c_str(), figure.limit,
                    figure.what.c_str());
        all = all && figure.holds();
    }
    return all;
}

/// In a process of its own: an attack may use up descriptors and threads, and must end. Returns whether it was
/// withstood.
bool withstood(const Attack& attack, const std::string& program) {
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        ::alarm(most_seconds);
        bool held = false;
        try {
            held = report(attack, attack.run(program));
        } catch (const std::exception& error) {
            std::printf("BROKEN  %-24s the attack itself failed: %s\n", std::string(attack.name).c_str(), error.what());
        }
        std::fflush(stdout);
        ::_exit(held ? 0 : 1);
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child) {
        std::printf("BROKEN  %-24s no process for it: %s\n", std::string(attack.name).c_str(), std::strerror(errno));
        return false;
    }
    if (WIFSIGNALED(status))
        std::printf("BROKEN  %-24s ended by signal %d%s\n", std::string(attack.name).c_str(), WTERMSIG(status),
                    WTERMSIG(status) == SIGALRM ? ", ten minutes after it began" : "");
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool chosen(const Attack& attack, std::span<char* const> names) {
    return names.empty() ||
           std::any_of(names.begin(), names.end(), [&](const char* name) { return attack.name == name; });
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<char* const> names(argv + std::min(argc, 2), argv + argc);
    const bool known = std::all_of(names.begin(), names.end(), [](std::string_view name) {
        return std::any_of(attacks().begin(), attacks().end(), [&](const Attack& one) { return one.name == name; });
    });
    if (argc < 2 || !known) {
        std::fputs("usage: meniscus-hostile MENISCUSD [ATTACK...]\nattacks:\n", stderr);
        for (const Attack& attack : attacks())
            std::fprintf(stderr, "  %-24s %s\n", std::string(attack.name).c_str(), std::string(attack.what).c_str());
        return 2;
    }
    int held = 0;
    int broken = 0;
    for (const Attack& attack : attacks())
        if (chosen(attack, names)) ++(withstood(attack, argv[1]) ? held : broken);
    std::printf("%d held, %d did not\n", held, broken);
    return broken == 0 ? 0 : 1;
}
