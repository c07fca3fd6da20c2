// Names of sessions that look like another, or like none (N10).
#include <string>
#include <vector>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "connection/connection.hpp"
#include "conversion/settings_conversion.hpp"

namespace meniscus::hostile {

std::vector<Figure> invisible_names(const std::string& program) {
    const Target target(program);
    const client::Connection connection(target.address());
    int taken = 0;
    int refused = 0;
    const auto is_taken = [&](const std::string& name) {
        // Not by the client library, which refuses them itself.
        v1::CreateSessionRequest request;
        request.set_id(client::new_session_id());
        *request.mutable_settings() = conversion::to_wire(settings_of_attacks());
        request.mutable_description()->set_name(name);
        grpc::ClientContext context;
        connection.add_metadata(context, request.id());
        v1::CreateSessionResponse response;
        return connection.sessions->CreateSession(&context, request, &response).ok();
    };
    for (const char* name : {"wa\u034Fter", "wa\U0001D173ter", "\uFE0F", "\u200D\uFE0E", "\uD7B0\u1160", "wa\uFFFEter",
                             "wa\uFDD0ter", "wa\u3164ter", "wa\u180Bter", "wa\U000E0100ter", "wa\u2063ter"})
        taken += is_taken(name) ? 1 : 0;
    for (const char* name : {"water", "\U0001F30A\uFE0F", "\u0645\u06CC\u200C\u0631\u0648\u062F", "\u6C34\u67F1"})
        refused += is_taken(name) ? 0 : 1;
    return {{"names of 11 taken that look like others", static_cast<double>(taken), 0.0, ""},
            {"names of 4 in other scripts refused", static_cast<double>(refused), 0.0, ""}};
}

}  // namespace meniscus::hostile
