// USD as text (.usda): a mesh with normals and attributes, and a stage that shows the meshes of a sequence by value
// clips. Written by the format's description (openusd.org, "Value Clips", "UsdGeomMesh"); no USD program has opened it
// yet.
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>

#include "files/centered_positions.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/meshes/usda_writer.hpp"
#include "meniscus/number_text.hpp"

namespace meniscus::formats {
namespace {

constexpr std::string_view translated = "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
constexpr std::size_t flush_bytes = std::size_t{1} << 20;

// USD spells numbers that are not finite as Python does, and as append_shortest().

template <class Number>
void append_tuple(std::string& out, const Number* values, std::size_t components) {
    if (components > 1) out += '(';
    for (std::size_t i = 0; i < components; ++i) {
        if (i != 0) out += ", ";
        append_shortest(out, values[i]);
    }
    if (components > 1) out += ')';
}

/// The type of an attribute's array; normals, positions and colors have roles of their own.
std::string type_of(const NamedValues& values) {
    switch (values.type) {
        case ElementType::float32:
            return values.components == 1 ? "float[]" : values.components == 3 ? "vector3f[]" : "float4[]";
        case ElementType::uint8:
            return values.components == 1 ? "uchar[]" : values.components == 3 ? "color3f[]" : "color4f[]";
        case ElementType::int32:
            return "int[]";
        case ElementType::uint32:
            return "uint[]";
    }
    return {};
}

/// Renderers blur by this one.
bool is_velocity(const NamedValues& values) {
    return values.name == "velocity" && values.type == ElementType::float32 && values.components == 3;
}

/// USD's names begin with no digit: such a name gets a _ before it. So does one that begins with _ and a digit, so that
/// no two become one.
std::string primvar(const std::string& name) {
    const std::size_t first = name.find_first_not_of('_');
    const bool digit = first != std::string::npos && name[first] >= '0' && name[first] <= '9';
    return "primvars:" + (digit ? "_" + name : name);
}

class MeshWriter {
public:
    MeshWriter(AtomicFile& file, std::optional<double> time) : file_(file), time_(time) {}

    void write(const TriangleMesh& mesh) {
        out_ = "#usda 1.0\n(\n    defaultPrim = \"surface\"\n";
        if (time_)
            for (const char* name : {"startTimeCode", "endTimeCode"}) {
                out_ += "    " + std::string(name) + " = ";
                append_shortest(out_, *time_);
                out_ += '\n';
            }
        out_ += ")\n\ndef Mesh \"surface\"\n{\n    uniform token subdivisionScheme = \"none\"\n";
        points(mesh);
        array("int[]", "faceVertexCounts", mesh.triangles.size(), {}, [&](std::size_t) { out_ += '3'; });
        array("int[]", "faceVertexIndices", mesh.triangles.size(), {}, [&](std::size_t i) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                if (corner != 0) out_ += ", ";
                append_shortest(out_, mesh.triangles[i][corner]);
            }
        });
        if (mesh.normals.size() == mesh.positions.size())
            array("normal3f[]", "normals", mesh.normals.size(), "vertex",
                  [&](std::size_t i) { append_tuple(out_, mesh.normals[i].data(), 3); });
        for (const NamedValues& values : mesh.attributes) attribute(values);
        out_ += "}\n";
        flush(0);
    }

private:
    /// USD's points are float32: what that would merge is put in place by a translation.
    void points(const TriangleMesh& mesh) {
        const auto write = [&](const auto& positions) {
            array("point3f[]", "points", positions.size(), {}, [&](std::size_t i) {
                const auto& p = positions[i];
                const std::array narrow{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
                append_tuple(out_, narrow.data(), 3);
            });
        };
        if (!mesh.wide) return write(mesh.positions);
        const files::CenteredPositions centered(mesh.positions);
        out_ += time_ ? "    double3 xformOp:translate.timeSamples = {\n        " : "    double3 xformOp:translate = ";
        if (time_) append_shortest(out_, *time_);
        if (time_) out_ += ": ";
        append_tuple(out_, centered.middle.data(), 3);
        out_ += (time_ ? ",\n    }\n" : "\n") + std::string(translated);
        write(centered.positions);
    }

    template <class Element>
    void array(const std::string& type, const std::string& name, std::size_t count, const std::string& interpolation,
               const Element& element) {
        out_ += "    " + type + " " + name;
        if (time_) {
            out_ += ".timeSamples = {\n        ";
            append_shortest(out_, *time_);
            out_ += ": [";
        } else {
            out_ += " = [";
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (i != 0) out_ += ", ";
            element(i);
            flush(flush_bytes);
        }
        out_ += time_ ? "],\n    }\n" : "]";
        if (!time_)
            out_ += interpolation.empty() ? "\n" : " (\n        interpolation = \"" + interpolation + "\"\n    )\n";
        // An attribute's interpolation stands where it is declared, not with its samples.
        if (time_ && !interpolation.empty())
            out_ += "    " + type + " " + name + " (\n        interpolation = \"" + interpolation + "\"\n    )\n";
    }

    void attribute(const NamedValues& values) {
        const auto at = [&]<class Number>(Number) {
            return [this, &values](std::size_t i) {
                std::array<Number, 4> numbers{};
                std::memcpy(numbers.data(), values.data.data() + i * values.element_bytes(), values.element_bytes());
                append_tuple(out_, numbers.data(), values.components);
            };
        };
        const bool velocity = is_velocity(values);
        const std::string name = velocity ? "velocities" : primvar(values.name);
        const std::string interpolation = velocity ? "" : "vertex";
        switch (values.type) {
            case ElementType::float32:
                return array(type_of(values), name, values.count(), interpolation, at(float{}));
            case ElementType::int32:
                return array(type_of(values), name, values.count(), interpolation, at(std::int32_t{}));
            case ElementType::uint32:
                return array(type_of(values), name, values.count(), interpolation, at(std::uint32_t{}));
            case ElementType::uint8:
                return array(type_of(values), name, values.count(), interpolation, [&](std::size_t i) {
                    std::array<float, 4> shares{};
                    for (std::size_t c = 0; c < values.components; ++c) {
                        const auto value = std::to_integer<unsigned>(values.data[i * values.components + c]);
                        if (values.components == 1) return append_shortest(out_, value);
                        shares[c] = static_cast<float>(value) / 255.0F;
                    }
                    append_tuple(out_, shares.data(), values.components);
                });
        }
    }

    void flush(std::size_t above) {
        if (out_.size() < above) return;
        file_.write(out_);
        out_.clear();
    }

    AtomicFile& file_;
    std::optional<double> time_;
    std::string out_;
};

/// A path between at signs: three of them let it have one. folder: absolute.
std::string asset(const std::filesystem::path& file, const std::filesystem::path& folder) {
    std::error_code error;
    const auto relative = std::filesystem::relative(std::filesystem::absolute(file), folder, error);
    return "@@@./" + (error || relative.empty() ? file : relative).generic_string() + "@@@";
}

}  // namespace

void write_usda(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshWriting& writing) {
    AtomicFile file(path);
    MeshWriter(file, writing.time).write(mesh);
    file.commit();
}

void write_usda_clips(const std::filesystem::path& path, std::span<const UsdaClip> clips, const TriangleMesh& like) {
    std::string out = "#usda 1.0\n(\n    defaultPrim = \"surface\"\n";
    if (!clips.empty()) {
        out += "    startTimeCode = ";
        append_shortest(out, clips.front().time);
        out += "\n    endTimeCode = ";
        append_shortest(out, clips.back().time);
        out += '\n';
    }
    out +=
        ")\n\ndef Mesh \"surface\" (\n    clips = {\n        dictionary default = {\n            asset[] assetPaths = "
        "[";
    for (const UsdaClip& clip : clips)
        out += (&clip == clips.data() ? "" : ", ") + asset(clip.file, std::filesystem::absolute(path).parent_path());
    out += "]\n            string primPath = \"/surface\"\n";
    // Stage times, and which clip is in force from then on; stage times, and the times in the clips.
    for (const bool active : {true, false}) {
        out += std::string("            double2[] ") + (active ? "active" : "times") + " = [";
        for (std::size_t i = 0; i < clips.size(); ++i) {
            const std::array pair{clips[i].time, active ? static_cast<double>(i) : clips[i].time};
            if (i != 0) out += ", ";
            append_tuple(out, pair.data(), 2);
        }
        out += "]\n";
    }
    out += "        }\n    }\n)\n{\n    uniform token subdivisionScheme = \"none\"\n";
    // Clips have samples of what the stage declares.
    if (like.wide) out += "    double3 xformOp:translate\n" + std::string(translated);
    out += "    point3f[] points\n    int[] faceVertexCounts\n    int[] faceVertexIndices\n";
    const std::string by_vertex = " (\n        interpolation = \"vertex\"\n    )\n";
    if (!like.normals.empty()) out += "    normal3f[] normals" + by_vertex;
    for (const NamedValues& values : like.attributes)
        out += is_velocity(values) ? std::string("    vector3f[] velocities\n")
                                   : "    " + type_of(values) + ' ' + primvar(values.name) + by_vertex;
    write_file(path, out + "}\n");
}

}  // namespace meniscus::formats
