// Sessions that take all the memory of reconstructions, and then rest (D8).
#include <algorithm>
#include <vector>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "meniscus/error.hpp"

namespace meniscus::hostile {

namespace {

constexpr std::size_t sessions_limit = std::size_t{250} << 20;  ///< the six large sessions would take 700 MB
constexpr int sessions = 16;
constexpr int large_sessions_of_them = 6;

}  // namespace

std::vector<Figure> large_sessions(const std::string& program) {
    TargetOptions options;
    options.arguments = {"--total-memory-limit", std::to_string(sessions_limit),
                         "--memory-limit",       std::to_string(sessions_limit),
                         "--idle-buffers",       "3600"};
    const Target target(program, options);
    client::Client client(target.address());
    const auto before = static_cast<double>(target.peak_bytes());
    const std::vector<float> large = block_of_particles(44);
    const std::vector<float> small = block_of_particles(12);
    std::vector<client::Stream> streams;
    for (int i = 0; i < sessions; ++i) {
        const std::string id = client::new_session_id();
        Settings settings = settings_of_attacks();
        if (i < large_sessions_of_them) {
            settings.cell_size = 0.25;
            settings.mode = Mode::uniform;
        }
        client.create_session(id, settings);
        streams.push_back(client.stream(id, {.receive_meshes = false}));
    }
    int refused = 0;
    int refused_to_large = 0;
    for (std::uint64_t round = 0; round < 3; ++round)
        for (int i = 0; i < sessions; ++i) {
            const bool is_large = i < large_sessions_of_them;
            ParticleFrame frame;
            frame.positions = is_large ? large : small;
            try {
                streams[static_cast<std::size_t>(i)].push(frame, round, 0.0);
                streams[static_cast<std::size_t>(i)].next();
            } catch (const LimitExceeded&) {
                ++(is_large ? refused_to_large : refused);
            }
        }
    const double after = static_cast<double>(target.peak_bytes());
    // Beside the reconstructions there are the frames themselves, and what is encoded.
    return {{"frames of small sessions refused", static_cast<double>(refused), 0.0, ""},
            {"frames of large sessions refused, for which others can make room", static_cast<double>(refused_to_large),
             0.0, ""},
            {"memory at its peak, above that before", (after - before) / 1e6,
             1.5 * static_cast<double>(sessions_limit) / 1e6, "MB"}};
}

}  // namespace meniscus::hostile
