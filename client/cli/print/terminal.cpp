#include "cli/print/terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <string_view>

#include "description/label.hpp"

namespace meniscus::cli {
namespace {

// Control sequences of ECMA-48, and xterm's for a second screen.
constexpr std::string_view second_screen = "\x1b[?1049h\x1b[?25l";  // and no cursor
constexpr std::string_view first_screen = "\x1b[?25h\x1b[?1049l";
constexpr std::string_view top_left = "\x1b[H";
constexpr std::string_view erase_rest_of_line = "\x1b[K";
constexpr std::string_view erase_rest_of_screen = "\x1b[J";

void write_out(std::string_view text) {
    while (!text.empty()) {
        const ssize_t count = ::write(STDOUT_FILENO, text.data(), text.size());
        if (count <= 0) return;  // the terminal is closed; SIGHUP ends the program
        text.remove_prefix(static_cast<std::size_t>(count));
    }
}

winsize screen_size() {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
        size = {.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
    return size;
}

}  // namespace

Terminal::Terminal() {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ending, signal);
    pthread_sigmask(SIG_BLOCK, &ending, &signals_before_);
    signals_ = ::signalfd(-1, &ending, SFD_CLOEXEC | SFD_NONBLOCK);
    keys_ = ::tcgetattr(STDIN_FILENO, &settings_before_) == 0;
    if (!keys_) return;
    termios settings = settings_before_;
    settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

Terminal::~Terminal() {
    if (drawn_) write_out(first_screen);
    if (keys_) ::tcsetattr(STDIN_FILENO, TCSANOW, &settings_before_);
    if (signals_ >= 0) {
        signalfd_siginfo taken{};
        while (::read(signals_, &taken, sizeof taken) > 0) {
        }
        ::close(signals_);
    }
    pthread_sigmask(SIG_SETMASK, &signals_before_, nullptr);
}

void Terminal::draw(const std::string& text) {
    const winsize size = screen_size();
    std::string screen(drawn_ ? std::string_view{} : second_screen);
    drawn_ = true;
    screen += top_left;
    std::istringstream lines(text);
    std::string line;
    for (unsigned row = 0; row < size.ws_row && std::getline(lines, line); ++row) {
        if (row > 0) screen += "\r\n";
        screen += description::first_characters(line, size.ws_col);
        screen += erase_rest_of_line;
    }
    screen += erase_rest_of_screen;
    write_out(screen);
}

bool Terminal::wait_for_end(std::chrono::milliseconds time) const {
    const auto end = std::chrono::steady_clock::now() + time;
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        std::array<pollfd, 2> watched{pollfd{.fd = signals_, .events = POLLIN, .revents = 0},
                                      pollfd{.fd = keys_ ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0}};
        if (left <= 0 || ::poll(watched.data(), watched.size(), static_cast<int>(left)) <= 0) return false;
        if (watched[0].revents != 0) return true;
        char key = 0;
        if (::read(STDIN_FILENO, &key, 1) <= 0 || key == 'q' || key == 'Q') return true;
    }
}

}  // namespace meniscus::cli
