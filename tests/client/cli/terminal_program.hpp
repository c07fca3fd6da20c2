// A program in a terminal of its own, read to its last byte.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::test {

/// The end of a terminal's first process hangs the terminal up, and what has not been read by then is lost. So that
/// process only starts the program and stays until exit_code().
class TerminalProgram {
public:
    TerminalProgram(const std::vector<std::string>& command, unsigned short rows, unsigned short columns) {
        std::vector<std::string> environment{"TERM=xterm"};
        for (char** entry = environ; *entry != nullptr; ++entry)
            if (!std::string_view(*entry).starts_with("TERM=")) environment.emplace_back(*entry);
        const std::vector<char*> argv = pointers(command);
        const std::vector<char*> variables = pointers(environment);
        std::array<int, 2> report{};
        std::array<int, 2> held{};
        if (::pipe2(report.data(), O_CLOEXEC) != 0 || ::pipe2(held.data(), O_CLOEXEC) != 0) std::abort();
        const winsize size{.ws_row = rows, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
        first_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
        if (first_ == 0) start(argv, variables, report[1], held);
        ::close(report[1]);
        ::close(held[0]);
        held_ = held[1];
        if (::read(report[0], &program_, sizeof program_) != sizeof program_) std::abort();
        ::close(report[0]);
    }
    ~TerminalProgram() {
        if (first_ > 0) {
            signal(SIGKILL);
            exit_code();
        }
        ::close(terminal_);
    }
    TerminalProgram(const TerminalProgram&) = delete;
    TerminalProgram& operator=(const TerminalProgram&) = delete;

    /// The end of the terminal that a person would sit at.
    int terminal() const { return terminal_; }
    /// Its output up to the time when this text is there for the n-th time, nothing has come for half a minute, or the
    /// program has ended.
    std::string read_until(const std::string& text, int times = 1) const {
        std::string all;
        for (;;) {
            int found = 0;
            for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++found;
            pollfd watched{.fd = terminal_, .events = POLLIN, .revents = 0};
            std::array<char, 4096> bytes{};
            if (found >= times || ::poll(&watched, 1, 30'000) <= 0) return all;
            const ssize_t count = ::read(terminal_, bytes.data(), bytes.size());
            if (count <= 0) return all;
            all.append(bytes.data(), static_cast<std::size_t>(count));
        }
    }
    std::string read_to_its_end() const { return read_until("\n never drawn"); }
    void signal(int number) const { ::kill(program_, number); }
    /// Waits for it. 128 and the number of the signal that has ended it.
    int exit_code() {
        ::close(held_);
        int status = 0;
        ::waitpid(std::exchange(first_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    static std::vector<char*> pointers(const std::vector<std::string>& texts) {
        std::vector<char*> out;
        out.reserve(texts.size() + 1);
        for (const std::string& text : texts) out.push_back(const_cast<char*>(text.c_str()));
        out.push_back(nullptr);
        return out;
    }
    /// In the terminal's first process, which may call nothing but what a forked one may.
    [[noreturn]] static void start(const std::vector<char*>& argv, const std::vector<char*>& variables, int report,
                                   const std::array<int, 2>& held) {
        const pid_t program = ::fork();
        if (program == 0) {
            ::execve(argv[0], argv.data(), variables.data());
            ::_exit(127);
        }
        ::signal(SIGINT, SIG_IGN);  // Ctrl-C is for the program
        for (int i = 0; i < 3; ++i) ::close(i);
        ::close(held[1]);
        if (::write(report, &program, sizeof program) != sizeof program) ::_exit(127);
        int status = 0;
        ::waitpid(program, &status, 0);
        char none = 0;
        if (::read(held[0], &none, 1) != 0) ::_exit(127);
        ::_exit(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    }

    int terminal_ = -1;
    int held_ = -1;  ///< the terminal's first process stays as long as this is open
    pid_t first_ = -1;
    pid_t program_ = -1;
};

}  // namespace meniscus::test
