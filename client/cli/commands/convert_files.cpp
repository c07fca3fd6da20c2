#include "cli/commands/convert_files.hpp"

#include <algorithm>
#include <iostream>
#include <span>
#include <vector>

#include "cli/print/listener.hpp"
#include "cli/sequence/distinct_files.hpp"
#include "cli/sequence/file_pattern.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/bytes/extension.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/particles/particle_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {
namespace {

using formats::ParticleFormat;

struct FileToConvert {
    std::filesystem::path in;
    std::filesystem::path out;
};

std::vector<FileToConvert> files_of(const FileConversion& conversion) {
    FilePattern in(conversion.in);
    FilePattern out(conversion.out);
    in.require_no_other_notation();
    if (in.has_number() != out.has_number())
        throw InvalidInput("IN '" + conversion.in + "' and OUT '" + conversion.out + "' must both have {} or both not");
    if (!in.has_number()) {
        refuse_share_of_one(conversion.share, conversion.in);
        if (conversion.selection.is_given())
            throw InvalidInput("--start, --end, --step and --skip-missing need {} in IN, which is '" + conversion.in +
                               "'");
        return {{conversion.in, conversion.out}};
    }
    auto inputs = conversion.selection.files(in);
    if (conversion.share) conversion.share->keep(inputs);
    out.pad_like(in);
    std::vector<FileToConvert> files;
    files.reserve(inputs.size());
    for (const auto& [number, path] : inputs) files.push_back({path, out.at(number)});
    return files;
}

void check_files(const FileConversion& conversion, const std::vector<FileToConvert>& files) {
    DistinctFiles distinct;
    for (const FileToConvert& file : files) distinct.add_input(file.in);
    if (const FilePattern in(conversion.in); in.has_number())
        for (const auto& [number, path] : FilePattern(conversion.in).match_existing()) distinct.add_input(path);
    for (const FileToConvert& file : files) {
        check_folder(file.out);
        distinct.add_output(file.out);
    }
}

/// The name of the format of a file: the one that is given, or its extension's.
std::string format_name(const std::filesystem::path& path, const std::optional<std::string>& given,
                        const std::string& option) {
    if (given) return *given;
    check_named(path, false, option, names<ParticleFormat>);
    const std::string extension = formats::lower_extension(path);
    for (const MeshFormat format : choices<MeshFormat>)
        if (extension == "." + std::string(name_of(format))) return std::string(name_of(format));
    return std::string(name_of(formats::particle_format_of(path)));
}

}  // namespace

ParticleFormat written_particle_format(const std::string& name) {
    const auto format = find_by_name<ParticleFormat>(name);
    const std::span<const ParticleFormat> written = formats::written_particle_formats();
    if (format && std::ranges::find(written, *format) != written.end()) return *format;
    std::vector<std::string_view> known;
    known.reserve(written.size());
    for (const ParticleFormat f : written) known.push_back(name_of(f));
    throw InvalidInput("particles are written as " + listed(known) + ", not as '" + name + "'");
}

namespace {

MeshFormat written_mesh_format(const std::string& name) {
    const auto format = find_by_name<MeshFormat>(name);
    if (format && *format != MeshFormat::bricks) return *format;
    std::vector<std::string_view> known;
    for (const MeshFormat f : choices<MeshFormat>)
        if (f != MeshFormat::bricks) known.push_back(name_of(f));
    throw InvalidInput("meshes of files are written as " + listed(known) + ", not as '" + name + "'" +
                       (format ? ": bricks come from a reconstruction" : ""));
}

void say(const FileConversion& conversion, const FileToConvert& file, std::size_t count, const char* what) {
    if (conversion.verbosity.quiet) return;
    std::cerr << formats::input_name(file.in) << ": " << count << ' ' << what << ", " << formats::output_name(file.out)
              << '\n';
    require_listener();
}

void write(const FileConversion& conversion, const FileToConvert& file, const formats::Particles& particles) {
    const std::string name = format_name(file.out, conversion.format, "--format");
    formats::write_particles(file.out, particles, written_particle_format(name));
    say(conversion, file, particles.count(), "particles");
}

void write(const FileConversion& conversion, const FileToConvert& file, formats::TriangleMesh mesh) {
    if (conversion.without_levels) formats::leave_out_levels(mesh);
    const std::string name = format_name(file.out, conversion.format, "--format");
    formats::write_mesh(file.out, mesh, written_mesh_format(name));
    say(conversion, file, mesh.triangles.size(), "triangles");
}

void convert_file(const FileConversion& conversion, const FileToConvert& file) {
    const std::string format = format_name(file.in, conversion.input_format, "--input-format");
    std::optional<FileContent> content = conversion.content ? conversion.content : content_of(format);
    if (!content && formats::is_standard_stream(file.in))
        throw InvalidInput("standard input is read once: say by --particles or --mesh what it has");
    if (content != FileContent::mesh) {
        const auto particle_format = find_by_name<ParticleFormat>(format);
        if (!particle_format)
            throw InvalidInput(formats::input_name(file.in) + ": files of the format '" + format +
                               "' have no particles");
        const formats::Particles particles = formats::read_particles(file.in, particle_format, conversion.limits);
        if (content || particles.faces == 0) return write(conversion, file, particles);
    }
    const auto mesh_format = find_by_name<MeshFormat>(format);
    if (!mesh_format)
        throw InvalidInput(formats::input_name(file.in) + ": files of the format '" + format + "' have no mesh");
    write(conversion, file, formats::read_mesh(file.in, mesh_format, conversion.limits));
}

}  // namespace

std::optional<FileContent> content_of(const std::string& format_name) {
    const bool particles = find_by_name<ParticleFormat>(format_name).has_value();
    const bool mesh = find_by_name<MeshFormat>(format_name).has_value();
    if (!particles && !mesh) throw InvalidInput("'" + format_name + "' is no format of particles or meshes");
    if (particles && mesh) return std::nullopt;
    return particles ? FileContent::particles : FileContent::mesh;
}

void convert_files(const FileConversion& conversion) {
    const auto files = files_of(conversion);
    check_files(conversion, files);
    for (const FileToConvert& file : files) {
        format_name(file.in, conversion.input_format, "--input-format");
        const std::string out = format_name(file.out, conversion.format, "--format");
        if (!find_by_name<MeshFormat>(out)) written_particle_format(out);
    }
    for (const FileToConvert& file : files) convert_file(conversion, file);
}

}  // namespace meniscus::cli
