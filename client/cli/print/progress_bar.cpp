#include "cli/print/progress_bar.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string_view>

namespace meniscus::cli {
namespace {

constexpr std::size_t widest_bar = 30;
constexpr std::string_view erase_line = "\r\x1b[K";  // ECMA-48

bool is_terminal() {
    const char* const name = std::getenv("TERM");
    return isatty(STDERR_FILENO) != 0 && (name == nullptr || std::string_view(name) != "dumb");
}

std::size_t columns_of_terminal() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Past std::cerr, which shows controls as text; the terminal has what came before.
void write_line(const std::string& text) {
    std::cerr << std::flush;
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

std::string progress_line(std::size_t done, std::size_t all, double seconds, std::size_t columns) {
    const std::string count = std::to_string(done) + " of " + std::to_string(all) + " frames";
    std::string left;
    if (done > 0) {
        const double each = seconds / static_cast<double>(done);
        left = "  " + std::to_string(std::llround(std::ceil(each * static_cast<double>(all - done)))) + " s left";
    }
    std::string bar;
    const std::size_t taken = count.size() + left.size() + std::string_view("  []").size();
    if (columns > taken + 1) {  // a terminal begins a new line where the last column is written
        const std::size_t width = std::min(widest_bar, columns - taken - 1);
        const std::size_t full = all == 0 ? width : width * done / all;
        bar = "  [" + std::string(full, '=') + std::string(width - full, ' ') + "]";
    }
    return (count + bar + left).substr(0, columns > 0 ? columns - 1 : 0);
}

ProgressBar::ProgressBar(std::size_t frames, bool wanted) : frames_(frames), drawn_(wanted && is_terminal()) {
    draw();
}

ProgressBar::~ProgressBar() {
    erase();
}

double ProgressBar::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void ProgressBar::erase() const {
    if (drawn_) write_line(std::string(erase_line));
}

void ProgressBar::advance() {
    ++done_;
    draw();
}

void ProgressBar::draw() const {
    if (drawn_) write_line(std::string(erase_line) + progress_line(done_, frames_, seconds(), columns_of_terminal()));
}

}  // namespace meniscus::cli
