#include "recorded_session.hpp"

#include <stdlib.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

namespace meniscus::hostile {

std::vector<float> block_of_particles(std::size_t side, bool drops) {
    const float distance = drops ? 1.0F : 0.2F;
    std::vector<float> positions;
    positions.reserve(3 * side * side * side);
    for (std::size_t z = 0; z < side; ++z)
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x)
                for (const std::size_t i : {x, y, z}) positions.push_back(distance * static_cast<float>(i));
    return positions;
}

Settings settings_of_attacks() {
    Settings settings;
    settings.particle_radius = 0.1;
    settings.cell_size = 1.0;
    return settings;
}

Folder::Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "meniscus-hostile-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for recordings");
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string record(client::Client& client, const std::vector<float>& positions, std::uint64_t frames) {
    std::string id = client::new_session_id();
    client.create_session(id, settings_of_attacks());
    auto stream = client.stream(id, {.receive_meshes = false});
    ParticleFrame frame;
    frame.positions = positions;
    for (std::uint64_t i = 0; i < frames; ++i) stream.push(frame, i, 0.0);
    stream.finish();
    while (stream.next()) {
    }
    client.delete_session(id);
    const auto is_written = [&] {
        const auto all = client.recordings();
        return std::ranges::any_of(all, [&](const client::RecordingInfo& recording) {
            return recording.session_id == id && recording.frames == frames && !recording.being_written;
        });
    };
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_written()) {
        if (std::chrono::steady_clock::now() > give_up) throw std::runtime_error("the frames are not recorded");
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return id;
}

}  // namespace meniscus::hostile
