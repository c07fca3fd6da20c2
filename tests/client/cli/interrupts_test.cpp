// Signals that end a command which has begun something elsewhere.
#include "cli/surfaces/interrupts.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <optional>

namespace meniscus::cli {
namespace {

[[noreturn]] void wait_for_ever() {
    for (;;) ::pause();
}

TEST(InterruptsDeathTest, EndTheProcessBySignalAfterWhatIsToBeDoneBefore) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        EXPECT_EXIT(
            {
                const Interrupts interrupts([] { ::write(STDERR_FILENO, "farewell", 8); });
                ::kill(::getpid(), signal);
                wait_for_ever();
            },
            testing::KilledBySignal(signal), "farewell");
}

TEST(InterruptsDeathTest, EndTheProcessThoughThatTakesForEver) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            const Interrupts interrupts(wait_for_ever);
            ::alarm(2);  // SIGALRM, were it not ended within a second
            ::kill(::getpid(), SIGINT);
            wait_for_ever();
        },
        testing::KilledBySignal(SIGINT), "");
}

/// The exit code of a first process, as in a container, that is sent SIGTERM; none where there can be no such process.
std::optional<int> exit_code_of_a_first_process() {
    constexpr int cannot = 77;
    const pid_t outside = ::fork();
    if (outside == 0) {
        if (::unshare(CLONE_NEWUSER | CLONE_NEWPID) != 0) ::_exit(cannot);
        const pid_t first = ::fork();
        if (first == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            const Interrupts interrupts([] {});
            ::kill(::getpid(), SIGTERM);
            wait_for_ever();
        }
        ::alarm(10);
        int status = 0;
        ::waitpid(first, &status, 0);
        ::_exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
    }
    int status = 0;
    ::waitpid(outside, &status, 0);
    if (!WIFEXITED(status)) return -1;
    return WEXITSTATUS(status) == cannot ? std::nullopt : std::optional(WEXITSTATUS(status));
}

TEST(Interrupts, EndTheFirstProcessOfAContainerToo) {
    const auto code = exit_code_of_a_first_process();
    if (!code) GTEST_SKIP() << "no namespaces here";
    EXPECT_EQ(*code, 128 + SIGTERM);
}

TEST(InterruptsDeathTest, LeaveASignalIgnoredThatWas) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            ::signal(SIGHUP, SIG_IGN);
            const Interrupts interrupts([] {});
            ::kill(::getpid(), SIGHUP);
            ::_exit(7);
        },
        testing::ExitedWithCode(7), "");
}

TEST(Interrupts, LeaveSignalsAsTheyWereBefore) {
    struct sigaction before {};
    struct sigaction after {};
    ::sigaction(SIGINT, nullptr, &before);
    {
        const Interrupts interrupts([] {});
    }
    {
        const Interrupts again([] {});
    }
    ::sigaction(SIGINT, nullptr, &after);
    EXPECT_EQ(after.sa_handler, before.sa_handler);
}

}  // namespace
}  // namespace meniscus::cli
