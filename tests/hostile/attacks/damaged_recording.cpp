// A recording of which the disk has changed some bytes: nobody is to be sent a frame of them (D17).
#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"

namespace meniscus::hostile {

namespace {

constexpr std::uint64_t places = 400;
constexpr std::uint64_t frames = 4;

/// Four bytes of a file, changed for as long as this lives.
class Damage {
public:
    Damage(const std::filesystem::path& path, std::uint64_t place)
        : file_(path, std::ios::binary | std::ios::in | std::ios::out), place_(static_cast<std::streamoff>(place)) {
        file_.seekg(place_);
        file_.read(before_.data(), before_.size());
        std::array<char, 4> changed = before_;
        for (char& byte : changed) byte = static_cast<char>(~byte);
        put(changed);
    }
    ~Damage() { put(before_); }
    Damage(const Damage&) = delete;
    Damage& operator=(const Damage&) = delete;

private:
    void put(const std::array<char, 4>& bytes) {
        file_.seekp(place_);
        file_.write(bytes.data(), bytes.size());
        file_.flush();
    }

    std::fstream file_;
    const std::streamoff place_;
    std::array<char, 4> before_{};
};

std::vector<std::string> hashes(client::Client& client, const std::string& id) {
    std::vector<std::string> hashes;
    try {
        auto reader = client.read_recording(id, 1);
        while (const auto frame = reader.next()) hashes.push_back(mesh_sha256(frame->mesh()));
    } catch (const client::ServerError&) {
        // The frames before the error count.
    }
    return hashes;
}

/// Frames that are read from the file though they are not as they were.
int changed_particles(const std::filesystem::path& path, const std::vector<float>& positions) {
    int changed = 0;
    try {
        const formats::Recording recording(path);
        for (const formats::RecordedFrame& frame : recording.frames()) try {
                changed += recording.particles(frame).positions == positions ? 0 : 1;
            } catch (const InvalidInput&) {
            }
    } catch (const InvalidInput&) {
    }
    return changed;
}

}  // namespace

std::vector<Figure> damaged_recording(const std::string& program) {
    const Folder folder;
    TargetOptions options;
    options.arguments = {"--record", folder.path().string()};
    const Target target(program, options);
    client::Client client(target.address());
    const std::vector<float> positions = block_of_particles(8);
    const std::string id = record(client, positions, frames);
    const auto path = folder.path() / id / "000001.recording";
    const std::vector<std::string> whole = hashes(client, id);
    if (whole.size() != frames || changed_particles(path, positions) != 0)
        throw std::runtime_error("a whole recording is not read");
    const std::uint64_t size = std::filesystem::file_size(path);
    int changed_meshes = 0;
    int particles = 0;
    for (std::uint64_t i = 0; i < places; ++i) {
        const Damage damage(path, i * (size - 4) / (places - 1));
        for (const std::string& hash : hashes(client, id)) changed_meshes += hash == whole.front() ? 0 : 1;
        particles += changed_particles(path, positions);
    }
    return {{"meshes sent that are not as they were recorded", static_cast<double>(changed_meshes), 0.0, ""},
            {"frames of particles read that are not as they were recorded", static_cast<double>(particles), 0.0, ""}};
}

}  // namespace meniscus::hostile
