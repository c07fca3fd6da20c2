#include "pushing/push_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "meniscus/client/errors.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::pushing {
namespace {

constexpr const char* program_variable = "MENISCUS_PROGRAM";

bool is_program(const std::string& path) {
    return ::access(path.c_str(), X_OK) == 0;
}

[[noreturn]] void fail(const std::string& what, int error) {
    throw client::ServerError(what + ": " + std::generic_category().message(error), client::ErrorCode::unavailable);
}

/// Both ends of a connection. Those of the child lie above the standard streams, which they become.
std::array<int, 2> connected() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("no socket", errno);
    constexpr int first_beyond = STDERR_FILENO + 1;
    for (int& end : ends) {
        const int moved = ::fcntl(end, F_DUPFD_CLOEXEC, first_beyond);
        const int error = errno;
        ::close(end);
        end = moved;
        if (moved < 0) fail("no socket", error);
    }
    return ends;
}

/// What a new process is given.
class Spawning {
public:
    Spawning() {
        posix_spawn_file_actions_init(&actions_);
        posix_spawnattr_init(&attributes_);
    }
    ~Spawning() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    Spawning(const Spawning&) = delete;
    Spawning& operator=(const Spawning&) = delete;

    pid_t start(const std::string& program, std::vector<std::string> arguments, std::vector<std::string> environment,
                int input, int output) {
        // Signals that a thread of the caller holds back are to end this process, and SIGTERM where all of it ignores
        // that, too.
        sigset_t signals;
        sigemptyset(&signals);
        posix_spawnattr_setsigmask(&attributes_, &signals);
        sigaddset(&signals, SIGTERM);
        posix_spawnattr_setsigdefault(&attributes_, &signals);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
        pid_t process = -1;
        const int error = ::posix_spawn(&process, program.c_str(), &actions_, &attributes_, pointers(arguments).data(),
                                        pointers(environment).data());
        if (error != 0) fail(program + " cannot be started", error);
        return process;
    }

private:
    static std::vector<char*> pointers(std::vector<std::string>& texts) {
        std::vector<char*> out;
        out.reserve(texts.size() + 1);
        for (std::string& text : texts) out.push_back(text.data());
        out.push_back(nullptr);
        return out;
    }

    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

std::vector<std::string> environment_with(const std::string& token) {
    const std::string variable = "MENISCUS_TOKEN=";
    std::vector<std::string> out;
    for (char** each = environ; *each != nullptr; ++each)
        if (token.empty() || std::string_view(*each).rfind(variable, 0) != 0) out.emplace_back(*each);
    if (!token.empty()) out.push_back(variable + token);
    return out;
}

client::ErrorCode code_named(std::string_view name) {
    for (const client::ErrorCode code : choices<client::ErrorCode>)
        if (name_of(code) == name) return code;
    return client::ErrorCode::unknown;
}

/// The error that its last line tells of, as this library has it.
std::exception_ptr told_error(const JsonLine& line) {
    const auto code = line.find("code");
    return std::make_exception_ptr(client::ServerError(
        line.at("error"), code == line.end() ? client::ErrorCode::unknown : code_named(code->second)));
}

}  // namespace

std::string push_program(const char* what) {
    const char* const named = std::getenv(program_variable);
    if (named != nullptr && *named != '\0') {
        if (is_program(named)) return named;
    } else if (const char* const path = std::getenv("PATH")) {
        for (std::string_view rest = path; !rest.empty();) {
            const std::size_t size = std::min(rest.find(':'), rest.size());
            std::string candidate = std::string(rest.substr(0, size)) + "/meniscus";
            if (size != 0 && is_program(candidate)) return candidate;
            rest.remove_prefix(std::min(size + 1, rest.size()));
        }
    }
    const bool is_named = named != nullptr && *named != '\0';
    throw NotBuilt(what,
                   "the service: build it without -DMENISCUS_SERVICE=OFF, where gRPC is installed, or let the "
                   "program meniscus of a build with it push frames, which is neither " +
                       (is_named ? program_variable + std::string(" (") + named + ")"
                                 : std::string("named by ") + program_variable) +
                       " nor in PATH");
}

PushProcess::PushProcess(const std::string& program, const std::vector<std::string>& arguments,
                         const std::string& token)
    : program_(program) {
    const std::array<int, 2> input = connected();
    input_ = input[0];
    const std::array<int, 2> answers = connected();
    answers_ = answers[0];
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    try {
        process_ = Spawning().start(program, words, environment_with(token), input[1], answers[1]);
    } catch (...) {
        for (const int end : {input[0], input[1], answers[0], answers[1]}) ::close(end);
        throw;
    }
    ::close(input[1]);
    ::close(answers[1]);
    listener_ = std::thread([this] { listen(); });
}

PushProcess::~PushProcess() {
    cancel();
    listener_.join();
    ::close(input_);
    ::close(answers_);
}

void PushProcess::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        // A pipe would send SIGPIPE to this process once nobody reads it.
        const ssize_t sent = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) {
            std::unique_lock lock(mutex_);
            fail_ended(lock);
        }
        bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
}

void PushProcess::finish() {
    ::shutdown(input_, SHUT_WR);
}

PushProcess::Answer PushProcess::next(std::optional<std::chrono::milliseconds> timeout) {
    std::unique_lock lock(mutex_);
    const auto is_there = [this] { return !lines_.empty() || has_ended_ || is_canceled_; };
    if (timeout)
        changed_.wait_for(lock, *timeout, is_there);
    else
        changed_.wait(lock, is_there);
    if (is_canceled_) return {std::nullopt, true};
    if (lines_.empty()) {
        if (has_ended_ && error_) std::rethrow_exception(error_);
        return {std::nullopt, has_ended_};
    }
    Answer answer{std::move(lines_.front())};
    lines_.pop_front();
    return answer;
}

void PushProcess::cancel() {
    const std::lock_guard lock(mutex_);
    is_canceled_ = true;
    if (process_ > 0) ::kill(process_, SIGTERM);
    changed_.notify_all();
}

void PushProcess::fail_ended(std::unique_lock<std::mutex>& lock) {
    changed_.wait(lock, [this] { return has_ended_ || is_canceled_; });
    if (is_canceled_) throw client::ServerError("the stream was canceled", client::ErrorCode::canceled);
    if (error_) std::rethrow_exception(error_);
    throw client::ServerError("the stream has ended: finish() was called", client::ErrorCode::failed_precondition);
}

void PushProcess::listen() {
    std::array<char, std::size_t{16} << 10> buffer{};
    std::string waiting;
    while (true) {
        const ssize_t count = ::recv(answers_, buffer.data(), buffer.size(), 0);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        waiting.append(buffer.data(), static_cast<std::size_t>(count));
        for (std::size_t end = waiting.find('\n'); end != std::string::npos; end = waiting.find('\n')) {
            take(std::string_view(waiting).substr(0, end));
            waiting.erase(0, end + 1);
        }
    }
    take_end();
}

void PushProcess::take(std::string_view text) {
    const std::lock_guard lock(mutex_);
    try {
        JsonLine line = read_json_line(text);
        if (const auto dropped = line.find("dropped"); dropped != line.end()) {
            std::uint64_t number = 0;
            const std::string& digits = dropped->second;
            std::from_chars(digits.data(), digits.data() + digits.size(), number);
            dropped_ = number;
        }
        if (line.find("error") != line.end()) {
            error_ = told_error(line);
            said_all_ = true;
        } else if (line.find("ended") != line.end()) {
            said_all_ = true;
        } else {
            lines_.push_back(std::move(line));
        }
    } catch (const client::ServerError&) {
        if (!error_) error_ = std::current_exception();
    }
    changed_.notify_all();
}

void PushProcess::take_end() {
    int status = 0;
    pid_t process = -1;
    {
        const std::lock_guard lock(mutex_);
        process = process_;
    }
    // Waits without taking it away, so that its number stays its own for cancel().
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
    }
    const std::lock_guard lock(mutex_);
    ::waitpid(process, &status, 0);
    process_ = -1;
    has_ended_ = true;
    if (!said_all_ && !error_)
        error_ = std::make_exception_ptr(
            client::ServerError(program_ + " push ended " +
                                    (WIFSIGNALED(status) ? "by signal " + std::to_string(WTERMSIG(status))
                                                         : "with exit code " + std::to_string(WEXITSTATUS(status))) +
                                    " and told no reason here; standard error may have it",
                                client::ErrorCode::unavailable));
    changed_.notify_all();
}

}  // namespace meniscus::pushing
