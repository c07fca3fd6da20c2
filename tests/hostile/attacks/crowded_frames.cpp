// Valid frames that are more work than they look: all particles in few places (D4).
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
#include "meniscus/settings.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int megabyte = 87'000;                  ///< particles of 12 bytes
constexpr double frame_seconds = 10.0;            ///< --max-frame-seconds of the first server
constexpr double least_seconds = 2.0;             ///< time that a frame may always take
constexpr double times_of_an_evenly_spread = 20;  ///< limit over the time of an evenly spread frame

/// As many particles of each level, at rest.
Case evenly_spread_as(const Case& attack) {
    const auto large = static_cast<int>(std::ranges::count(attack.levels, 3));
    const auto small = static_cast<int>(attack.positions.size() / 3) - large;
    Case even{"", attack.settings, together(evenly_spread(small), evenly_spread(large, 16.0F))};
    if (large != 0) {
        even.levels.assign(even.positions.size() / 3, 3);
        std::fill_n(even.levels.begin(), small, std::uint8_t{0});
    }
    return even;
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        const std::string name(name_of(mode));
        Settings coarse = settings_of(Field::color, 10.0, mode);
        coarse.smoothing_length = 0.1;
        all.push_back({"one place at coarse cells, " + name, coarse, clumps(1, megabyte, 0.0F)});
        all.push_back({"a millionth apart at coarse cells, " + name, coarse, clumps(1, megabyte, 1e-6F)});
        all.push_back({"half in one place at coarse cells, " + name, coarse,
                       together(evenly_spread(megabyte / 2), clumps(1, megabyte / 2, 0.05F))});
        for (const Field field : {Field::smooth, Field::color, Field::density}) {
            const std::string of = std::string(name_of(field)) + ", " + name;
            const Settings settings = settings_of(field, 0.5, mode);
            all.push_back({"one place, " + of, settings, clumps(1, megabyte, 0.0F)});
            all.push_back({"within one radius, " + of, settings, clumps(1, megabyte, 0.5F)});
            all.push_back({"109 clumps, " + of, settings, clumps(109, megabyte / 109, 0.1F)});
            all.push_back({"all alone, " + of, settings, evenly_spread(megabyte, 13.0F)});
            all.push_back({"half in one place, " + of, settings,
                           together(evenly_spread(megabyte / 2), clumps(1, megabyte / 2, 0.01F))});
        }
    }
    // A large particle is near 512 times as many places as a small one.
    for (const Field field : {Field::smooth, Field::color, Field::density})
        for (const int number : {10, 109, 435}) all.push_back(clumps_among_small(field, number, megabyte / 2));
    Settings fine = settings_of(Field::color, 1.0 / 64.0, Mode::adaptive);
    fine.edge_points = Bisection{7};
    all.push_back({"a clump at the finest cells, bisected", fine, clumps(1, 4000, 0.0F)});
    all.push_back({"20 clumps at the finest cells", settings_of(Field::color, 1.0 / 64.0, Mode::adaptive),
                   clumps(20, 800, 0.0F)});
    return all;
}

/// Seconds until a frame is answered or refused.
double seconds_of(client::Client& client, const Case& frame_of) {
    const std::string id = "00000000-0000-4000-8000-00000000d4d4";
    client.create_session(id, frame_of.settings);
    const auto start = Clock::now();
    try {
        send(client, id, frame_of);
    } catch (const LimitExceeded&) {
        // Refused or stopped.
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    client.delete_session(id);
    return seconds;
}

/// The worst of all frames' seconds over those that each may take.
Figure worst_frame(const std::string& program) {
    TargetOptions options;
    options.arguments = {"--max-frame-seconds", std::to_string(frame_seconds)};
    Target target(program, options);
    client::Client client(target.address());
    Figure worst{"the longest frame beside its limit", 0.0, 1.0, ""};
    for (const Case& attack : cases()) {
        const double seconds = seconds_of(client, attack);
        double limit = least_seconds;
        if (seconds > limit)
            limit = std::max(limit, times_of_an_evenly_spread * seconds_of(client, evenly_spread_as(attack)));
        limit = std::min(limit, frame_seconds + 0.2);
        if (seconds / limit > worst.value)
            worst = {"the longest frame over what it may take: " + attack.name, seconds / limit, 1.0, ""};
    }
    return worst;
}

/// A frame of honest work that takes long: water at fine cells.
void hold_the_device(const std::string& address) {
    client::Client client(address);
    try {
        seconds_of(client, {"", settings_of(Field::smooth, 1.0 / 16.0, Mode::uniform), evenly_spread(20'000)});
    } catch (const std::exception&) {
        // It was stopped, or the server has gone.
    }
}

/// How long another session's small frame waits behind one that takes long, where a frame has the device for a second.
Figure wait_of_another(const std::string& program) {
    TargetOptions options;
    options.arguments = {"--max-frame-seconds", "1", "--max-frame-work", "0"};
    Target target(program, options);
    std::atomic<bool> over = false;
    std::thread attacker([&] {
        hold_the_device(target.address());
        over = true;
    });
    client::Client client(target.address());
    const auto attacked = [&] {
        const auto sessions = client.sessions();
        return !sessions.empty() && sessions.front().uploading;
    };
    while (!over && !attacked()) std::this_thread::yield();
    const std::string id = "00000000-0000-4000-8000-00000000d4d5";
    client.create_session(id, settings_of(Field::smooth, 1.0, Mode::adaptive));
    client::Stream stream = client.stream(id, {.receive_meshes = false});
    const Positions positions = evenly_spread(200);
    ParticleFrame frame;
    frame.positions = positions;
    const auto start = Clock::now();
    stream.push(frame, 0, 0.0);
    static_cast<void>(stream.next());
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    attacker.join();
    return {"another session's frame, where one has the device for 1 s", seconds, 1.2, "s"};
}

}  // namespace

std::vector<Figure> crowded_frames(const std::string& program) {
    return {worst_frame(program), wait_of_another(program)};
}

}  // namespace meniscus::hostile
