// A screen of text that is drawn again and again, until somebody wants it to end.
#pragma once

#include <termios.h>

#include <chrono>
#include <csignal>
#include <string>

namespace meniscus::cli {

/// To be made before any other thread: it takes the signals that would end the process, in order to leave the terminal
/// as it was found.
class Terminal {
public:
    Terminal();
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// Replaces the screen's content in one write, so that nothing flickers. Lines and columns beyond the screen are
    /// cut off.
    void draw(const std::string& text);
    /// True for q, Ctrl-C, or a signal to end; false after this time.
    bool wait_for_end(std::chrono::milliseconds time) const;

private:
    sigset_t signals_before_{};
    int signals_ = -1;   ///< readable once one has come
    bool keys_ = false;  ///< whether there is a keyboard
    termios settings_before_{};
    bool drawn_ = false;
};

}  // namespace meniscus::cli
