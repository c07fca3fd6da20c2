#include "cli/surfaces/interrupts.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <future>
#include <memory>
#include <system_error>
#include <utility>

namespace meniscus::cli {
namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};
constexpr std::chrono::milliseconds patience{600};

std::atomic<int> signal_pipe{-1};  ///< where the handler writes which signal has come

void write_signal(int signal) {
    const int error = errno;
    const auto number = static_cast<unsigned char>(signal);
    // The pipe is empty but for the first signals of each kind.
    [[maybe_unused]] const ssize_t written = ::write(signal_pipe, &number, 1);
    errno = error;
}

/// Calls it for as long as there is patience. Where it takes longer, the process ends in the meantime.
void call(const std::function<void()>& function) {
    auto done = std::make_shared<std::promise<void>>();
    std::future<void> called = done->get_future();
    std::thread([function, done] {
        function();
        done->set_value();
    }).detach();
    called.wait_for(patience);
}

}  // namespace

Interrupts::Interrupts(std::function<void()> before_end) : before_end_(std::move(before_end)) {
    if (::pipe2(pipe_.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
    signal_pipe = pipe_[1];
    thread_ = std::thread([this] { wait_for_signal(); });
    struct sigaction action {};
    action.sa_handler = write_signal;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    for (std::size_t i = 0; i < signals.size(); ++i) {
        ::sigaction(signals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals[i], &action, nullptr);
    }
}

Interrupts::~Interrupts() {
    for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &before_[i], nullptr);
    write_signal(0);
    thread_.join();
    signal_pipe = -1;
    for (const int end : pipe_) ::close(end);
}

void Interrupts::wait_for_signal() {
    unsigned char signal = 0;
    while (::read(pipe_[0], &signal, 1) < 0 && errno == EINTR) {
    }
    if (signal == 0) return;
    call(before_end_);
    ::signal(signal, SIG_DFL);
    ::kill(::getpid(), signal);
    ::_exit(128 + signal);  // the first process of a container, which no signal ends by itself
}

}  // namespace meniscus::cli
