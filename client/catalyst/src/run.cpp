#include "run.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <memory>
#include <string>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "parts_frames.hpp"
#include "session_frames.hpp"

namespace meniscus::catalyst {
namespace {

std::optional<int> communicator(const Node& params) {
    const Node handle = params.at("catalyst/mpi_comm");
    if (!handle) return std::nullopt;
    const auto number = handle.integer();
    if (!number || *number < std::numeric_limits<int>::min() || *number > std::numeric_limits<int>::max())
        throw InvalidInput("catalyst/mpi_comm is no whole number, must be that of MPI_Comm_c2f()");
    return static_cast<int>(*number);
}

}  // namespace

Run::Run(const Node& params, const char* environment) : ranks_(communicator(params)) {
    notices_.speak_for(ranks_.rank());
    std::exception_ptr error;
    try {
        options_ = read_run_options(params, environment, notices_);
        if (ranks_.size() > 1)
            for (const char* const own : {"parts", "part", "run"})
                if (options_.session.contains(own))
                    throw InvalidInput("option " + quoted(own) +
                                       " is set, but the ranks of catalyst/mpi_comm have their own");
    } catch (...) {
        error = std::current_exception();
    }
    if (ranks_.least({error == nullptr ? 1 : 0, 0})[0] == 0) {
        if (error != nullptr) std::rethrow_exception(error);
        throw Failure(MENISCUS_FAILED_PRECONDITION, "another rank's options were refused, which says why");
    }
    // Ranks that make surfaces meet in other calls than those that do not.
    if (ranks_.least({options_.makes_surfaces ? 1 : 0, options_.makes_surfaces ? 0 : 1}) == std::array{0, 0})
        throw InvalidInput(
            "option 'reconstruct-ranks' or 'output' is set on some ranks alone, must be the same on all");
    if (params.at("catalyst/pipelines")) notices_.say_once("catalyst/pipelines is passed over: none are run here");
    if (options_.makes_surfaces)
        frames_ = std::make_unique<PartsFrames>(options_, ranks_, notices_);
    else
        frames_ = std::make_unique<SessionFrames>(options_, ranks_, notices_);
}

Node Run::mesh(const Node& params) {
    Node found(nullptr);
    std::string names;
    for (const Node& channel : params.at("catalyst/channels").children()) {
        const std::string name = channel.name();
        names += (names.empty() ? "" : ", ") + quoted(name);
        const std::string type = channel.at("type").text().value_or("");
        const bool is_mesh = type == "mesh";
        if (is_mesh && options_.channel.empty()) options_.channel = name;  // and so it stays
        if (name != options_.channel) {
            notices_.say_once("channel " + quoted(name) + " is passed over: " +
                              (is_mesh ? "option 'channel' chooses another one than " + quoted(options_.channel)
                                       : "it is of type " + quoted(type) + ", must be mesh"));
            continue;
        }
        if (!is_mesh) throw InvalidInput("channel " + quoted(name) + " is of type " + quoted(type) + ", must be mesh");
        found = channel.at("data");
        // A channel may have a state of its own.
        if (const Node state = channel.at("state")) read_state(state);
    }
    const bool nothing = found.children().empty();
    if (nothing && ranks_.size() == 1)
        throw InvalidInput("there is no mesh of channel " +
                           (options_.channel.empty() ? "type mesh" : quoted(options_.channel)) + ", the channels are " +
                           (names.empty() ? "none" : names));
    return nothing ? Node(nullptr) : found;
}

void Run::read_state(const Node& state) {
    for (const char* const name : {"timestep", "cycle"})
        if (const Node number = state.at(name)) {
            const auto index = number.integer();
            if (!index || *index < 0)
                throw InvalidInput("catalyst/state/" + std::string(name) + " is not a whole number from 0 on");
            index_ = static_cast<std::uint64_t>(*index);
            break;
        }
    if (const auto time = state.at("time").number()) time_ = *time;
}

void Run::require_order() const {
    if (index_ < next_index_)
        throw InvalidInput("catalyst/state/timestep is " + std::to_string(index_) + " after " +
                           std::to_string(next_index_ - 1) + ", must increase from frame to frame");
}

const meniscus_particles& Run::particles(const Node& params) {
    // The same on all ranks, also after a frame that one of them refused.
    index_ = std::max(next_index_, executed_++);
    time_ = static_cast<double>(index_);
    const Node state = params.at("catalyst/state");
    if (!state) notices_.say_once("catalyst/state is missing: frames are numbered from 0, and a number is its time");
    read_state(state);
    const Node found = mesh(params);
    require_order();
    return found ? particles_.read(found, options_, notices_) : particles_.empty();
}

void Run::execute(const Node& params) {
    const meniscus_particles* given = nullptr;
    std::exception_ptr error;
    try {
        given = &particles(params);
    } catch (...) {
        error = std::current_exception();
    }
    if (given != nullptr) next_index_ = index_ + 1;
    frames_->push(given, index_, time_);
    if (error != nullptr) std::rethrow_exception(error);
}

}  // namespace meniscus::catalyst
