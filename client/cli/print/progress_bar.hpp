// How far a sequence is, on one line of a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace meniscus::cli {

/// "12 of 60 frames  [====      ]  34 s left". seconds: passed since the first began. columns: of the terminal, which
/// the line stays within.
std::string progress_line(std::size_t done, std::size_t all, double seconds, std::size_t columns);

/// On stderr, where that is a terminal that knows how to erase a line; else nothing of it is seen.
class ProgressBar {
public:
    /// wanted: if not, nothing is drawn. Begins to count the time.
    ProgressBar(std::size_t frames, bool wanted);
    /// Erases it.
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    bool is_drawn() const { return drawn_; }
    /// Since it was made.
    double seconds() const;
    /// Takes it away for lines that are written in its place.
    void erase() const;
    /// Draws it with one frame more.
    void advance();

private:
    void draw() const;

    std::size_t frames_;
    bool drawn_;
    std::size_t done_ = 0;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace meniscus::cli
