#include "formats/particles/particle_formats.hpp"

#include <algorithm>
#include <vector>

#include "formats/bytes/extension.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {

std::span<const std::string_view> particle_extensions() {
    static const std::vector<std::string_view> all = [] {
        std::vector<std::string_view> extensions;
        for (const ParticleFormatRow& row : particle_formats)
            for (const std::string_view extension : row.extensions)
                if (!extension.empty()) extensions.push_back(extension);
        return extensions;
    }();
    return all;
}

std::span<const ParticleFormat> written_particle_formats() {
    static const std::vector<ParticleFormat> all = [] {
        std::vector written{ParticleFormat::ply};
        for (const ParticleFormatRow& row : particle_formats)
            if (row.write != nullptr && row.format != ParticleFormat::ply) written.push_back(row.format);
        return written;
    }();
    return all;
}

ParticleFormat particle_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    const std::string zipped = extension == ".gz" ? lower_extension(path.stem()) + extension : extension;
    for (const ParticleFormatRow& row : particle_formats)
        if (!zipped.empty() && std::find(row.extensions.begin(), row.extensions.end(), zipped) != row.extensions.end())
            return row.format;
    throw InvalidInput(path.string() + ": particle files end in " + listed(particle_extensions()) + ", not in '" +
                       extension + "'");
}

}  // namespace meniscus::formats
