// Signals that end a command which has begun something elsewhere.
#include "cli/interrupts.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>

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
