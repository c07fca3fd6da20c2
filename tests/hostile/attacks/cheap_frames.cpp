// Frames of a megabyte or less that pass the estimate of their work and hold the device for long, at the defaults (N8).
#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../crowds.hpp"
#include "../target.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/error.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int not_probed = 16'384;
constexpr int megabyte = 87'000;  ///< particles of 12 bytes

std::vector<Case> cases() {
    std::vector<Case> all;
    all.push_back({"16,384 evenly spread at c = 0.03", settings_of(Field::color, 0.03, Mode::uniform),
                   evenly_spread(not_probed)});
    all.push_back({"16,384 all alone at c = 0.03", settings_of(Field::color, 0.03, Mode::uniform),
                   evenly_spread(not_probed, 13.0F)});
    for (const double cell_size : {0.2, 0.25}) {
        Case large{"14 clumps of level 3 at c = " + std::to_string(cell_size),
                   settings_of(Field::smooth, cell_size, Mode::adaptive), clumps(14, 1000, 8.0F)};
        large.levels.assign(14'000, 3);
        all.push_back(std::move(large));
    }
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings fine = settings_of(Field::color, 1.0 / 36.0, mode);
        fine.edge_points = Bisection{7};
        all.push_back({"16 clumps at c = 1/36, bisected, " + std::string(name_of(mode)), fine, clumps(16, 1000, 0.1F)});
    }
    for (const Field field : {Field::smooth, Field::color})
        for (const int number : {109, 435}) all.push_back(clumps_among_small(field, number, megabyte / 2));
    all.push_back(clumps_among_small(Field::color, 10, megabyte / 2));
    return all;
}

/// Seconds that another session's small frame waits beside this one, which is given up then.
double wait_beside(const std::string& address, const Case& attack) {
    const std::string attackers = client::new_session_id();
    const std::string id = client::new_session_id();
    client::Client attacker(address);
    client::Client client(address);
    attacker.create_session(attackers, attack.settings);
    client.create_session(id, settings_of(Field::smooth, 1.0, Mode::adaptive));
    std::atomic<bool> over{false};
    std::thread attacking([&] {
        try {
            send(attacker, attackers, attack);
        } catch (const std::exception&) {
            // Refused, stopped, or given up.
        }
        over = true;
    });
    client::Stream stream = client.stream(id, {.receive_meshes = false});
    const Positions positions = evenly_spread(200);
    ParticleFrame frame;
    frame.positions = positions;
    // The first one shows when the device is taken: a frame that comes then is answered late, or never was there one.
    double longest = 0.0;
    const auto until = Clock::now() + std::chrono::seconds(8);
    for (std::uint64_t i = 0; !over && Clock::now() < until; ++i) {
        const auto begin = Clock::now();
        stream.push(frame, i, 0.0);
        static_cast<void>(stream.next());
        longest = std::max(longest, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    client.delete_session(attackers);
    attacking.join();
    client.delete_session(id);
    return longest;
}

}  // namespace

std::vector<Figure> cheap_frames(const std::string& program) {
    const Target target(program);
    std::vector<Figure> figures;
    for (const Case& attack : cases())
        figures.push_back(
            {"another session's small frame, beside " + attack.name, wait_beside(target.address(), attack), 6.0, "s"});
    return figures;
}

}  // namespace meniscus::hostile
