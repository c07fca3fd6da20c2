// The five functions of a Catalyst implementation.
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <optional>

#include "failure.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "protocol.h"
#include "run.hpp"

namespace meniscus::catalyst {
namespace {

std::unique_ptr<Run> run;

Run& running() {
    if (run == nullptr)
        throw Failure(MENISCUS_FAILED_PRECONDITION, "catalyst_initialize() comes first, and has to succeed");
    return *run;
}

/// 200 and the number of the C interface's error, without its sign.
/// message: empty where another rank says it.
catalyst_status failed(meniscus_result result, const std::string& message) {
    if (!message.empty()) std::cerr << "meniscus: " + visible(message) + "\n";
    return static_cast<catalyst_status>(int{catalyst_status_meniscus_first} - int{result});
}

/// What happens is said on the standard error output, and no exception reaches the simulation.
template <class Body>
catalyst_status guarded(Body&& body) noexcept {
    try {
        body();
        return catalyst_status_ok;
    } catch (const Failure& error) {
        return failed(error.result(), error.what());
    } catch (const InvalidInput& error) {
        return failed(MENISCUS_INVALID_INPUT, error.what());
    } catch (const NotBuilt& error) {
        return failed(MENISCUS_UNIMPLEMENTED, error.what());
    } catch (const std::bad_alloc&) {
        return failed(MENISCUS_OUT_OF_MEMORY, "not enough memory is left");
    } catch (const std::exception& error) {
        return failed(MENISCUS_INTERNAL, error.what());
    } catch (...) {
        return failed(MENISCUS_UNKNOWN, "an exception that is none of this library's");
    }
}

catalyst_status initialize(const conduit_node* params) {
    return guarded([&] {
        if (run != nullptr) throw Failure(MENISCUS_FAILED_PRECONDITION, "catalyst_initialize() comes once");
        run = std::make_unique<Run>(Node(params), std::getenv("MENISCUS_CATALYST"));
    });
}

catalyst_status execute(const conduit_node* params) {
    return guarded([&] { running().execute(Node(params)); });
}

catalyst_status finalize(const conduit_node* /*params*/) {
    return guarded([&] {
        const std::unique_ptr<Run> ended = std::move(run);
        if (ended != nullptr) ended->finish();  // else initialize has said why there is none
    });
}

catalyst_status about(conduit_node* params) {
    catalyst_conduit_node_set_path_char8_str(params, "catalyst/implementation", "meniscus");
    catalyst_conduit_node_set_path_char8_str(params, "meniscus/version", meniscus_version());
    return catalyst_status_ok;
}

catalyst_status results(conduit_node* params) {
    return guarded([&] {
        const Frames& frames = running().frames();
        if (frames.output().empty())
            catalyst_conduit_node_set_path_char8_str(params, "meniscus/session", frames.session_id().c_str());
        else
            catalyst_conduit_node_set_path_char8_str(params, "meniscus/output", frames.output().c_str());
        catalyst_conduit_node_set_path_int64(params, "meniscus/frames_sent", static_cast<std::int64_t>(frames.sent()));
        catalyst_conduit_node_set_path_int64(params, "meniscus/frames_left_out",
                                             static_cast<std::int64_t>(frames.left_out()));
    });
}

}  // namespace
}  // namespace meniscus::catalyst

extern "C" {
extern const catalyst_impl catalyst_api_impl __attribute__((visibility("default")));
const catalyst_impl catalyst_api_impl{1,
                                      meniscus::catalyst::initialize,
                                      meniscus::catalyst::execute,
                                      meniscus::catalyst::finalize,
                                      meniscus::catalyst::about,
                                      meniscus::catalyst::results};
}
