// GLB and USDA: what the files say, read back by a JSON parser and by eye.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "formats/bytes/scalar.hpp"
#include "formats/meshes/glb_writer.hpp"
#include "formats/meshes/usda_writer.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::test {
namespace {

using formats::TriangleMesh;
using nlohmann::json;

/// With an attribute of every form.
TriangleMesh attributed_tetrahedron() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {0, 0, 6}};
    mesh.normals = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    mesh.levels = {1, 2, 3, 0};
    mesh.attributes = {
        values_of<float>("velocity", ElementType::float32, 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}),
        values_of<float>("age", ElementType::float32, 1, {0.5F, 1.5F, 2.5F, 3.5F}),
        values_of<std::uint8_t>("color", ElementType::uint8, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 255}),
        values_of<std::uint8_t>("phase", ElementType::uint8, 1, {0, 1, 2, 255}),
        values_of<std::int32_t>("id", ElementType::int32, 1, {-7, 0, 5, 1 << 24}),
        values_of<std::uint32_t>("far", ElementType::uint32, 1, {1, 2, 3, 4'000'000'001U}),
    };
    return mesh;
}

struct Glb {
    json document;
    std::string buffer;

    explicit Glb(const std::string& file) {
        const auto number = [&](std::size_t at) {
            return formats::load<std::uint32_t>(file.data() + at, std::endian::little);
        };
        EXPECT_EQ(file.substr(0, 4), "glTF");
        EXPECT_EQ(number(4), 2U);
        EXPECT_EQ(number(8), file.size());
        EXPECT_EQ(file.size() % 4, 0U);
        document = json::parse(file.substr(20, number(12)));
        const std::size_t next = 20 + number(12);
        if (next < file.size()) buffer = file.substr(next + 8, number(next));
    }
    const json& accessor(const std::string& attribute) const {
        return document["accessors"]
                       [document["meshes"][0]["primitives"][0]["attributes"][attribute].get<std::size_t>()];
    }
    /// A vertex's numbers of a plain file.
    template <class T>
    std::vector<T> at(const std::string& attribute, std::size_t vertex) const {
        const json& view = document["bufferViews"][accessor(attribute)["bufferView"].get<std::size_t>()];
        const std::string type = accessor(attribute)["type"];
        std::vector<T> out(type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0'));
        const std::size_t begin =
            view["byteOffset"].get<std::size_t>() + vertex * view["byteStride"].get<std::size_t>();
        std::memcpy(out.data(), buffer.data() + begin, out.size() * sizeof(T));
        return out;
    }
};

TEST(GlbWriter, EveryAttributeIsWhereItsAccessorSays) {
    const Glb glb(formats::to_glb(attributed_tetrahedron()));
    EXPECT_EQ(glb.document["nodes"][0]["translation"], json({1.0, 2.0, 3.0}));
    EXPECT_EQ(glb.at<float>("POSITION", 3), (std::vector<float>{-1, -2, 3}));
    EXPECT_EQ(glb.accessor("POSITION")["min"], json({-1.0, -2.0, -3.0}));
    EXPECT_EQ(glb.accessor("POSITION")["max"], json({1.0, 2.0, 3.0}));
    EXPECT_EQ(glb.at<float>("NORMAL", 2), (std::vector<float>{0, 1, 0}));
    EXPECT_EQ(glb.at<float>("_VELOCITY", 1), (std::vector<float>{3, 4, 5}));
    EXPECT_EQ(glb.at<float>("_AGE", 3), std::vector<float>{3.5F});
    EXPECT_EQ(glb.at<std::uint8_t>("COLOR_0", 3), (std::vector<std::uint8_t>{10, 11, 255}));
    EXPECT_EQ(glb.accessor("COLOR_0")["normalized"], true);
    EXPECT_EQ(glb.at<std::uint8_t>("_PHASE", 3), std::vector<std::uint8_t>{255});
    EXPECT_EQ(glb.at<float>("_ID", 0), std::vector<float>{-7.0F});
    EXPECT_EQ(glb.at<std::uint16_t>("_FAR", 3),
              (std::vector<std::uint16_t>{4'000'000'001U & 0xFFFF, 4'000'000'001U >> 16}));
}

TEST(GlbWriter, WhatIsNotFiniteIsLeftOutSinceTheFormatKnowsNone) {
    TriangleMesh mesh = attributed_tetrahedron();
    mesh.normals[1][0] = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::memcpy(mesh.attributes[0].data.data(), &infinity, sizeof infinity);
    for (const auto coding : {formats::GlbCoding::plain, formats::GlbCoding::draco}) {
        const Glb glb(formats::to_glb(mesh, coding));
        const json& attributes = glb.document["meshes"][0]["primitives"][0]["attributes"];
        EXPECT_FALSE(attributes.contains("NORMAL"));
        EXPECT_FALSE(attributes.contains("_VELOCITY"));
        EXPECT_TRUE(attributes.contains("_AGE"));
    }
}

TEST(GlbWriter, WithoutASurfaceThereIsNoEmptyList) {
    for (const auto coding : {formats::GlbCoding::plain, formats::GlbCoding::draco}) {
        const Glb glb(formats::to_glb(TriangleMesh{}, coding));
        EXPECT_FALSE(glb.document.contains("meshes"));
        EXPECT_FALSE(glb.document.contains("extensionsUsed"));
    }
}

TEST(GlbWriter, DracoSaysItsExtensionAndCountsWhatItDecodesTo) {
    const Glb glb(formats::to_glb(attributed_tetrahedron(), formats::GlbCoding::draco));
    EXPECT_EQ(glb.document["extensionsRequired"], json({"KHR_draco_mesh_compression"}));
    const json& primitive = glb.document["meshes"][0]["primitives"][0];
    EXPECT_EQ(primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"].size(), 8U);
    EXPECT_EQ(glb.accessor("POSITION")["count"], 4);
    EXPECT_EQ(glb.document["accessors"][primitive["indices"].get<std::size_t>()]["count"], 12);
    EXPECT_EQ(glb.buffer.substr(0, 5), "DRACO");
}

TEST(GlbWriter, AMeshFarAwayKeepsItsShape) {
    TriangleMesh mesh = attributed_tetrahedron();
    for (auto& p : mesh.positions) p[0] += 1e9;
    mesh.wide = true;
    const Glb glb(formats::to_glb(mesh));
    EXPECT_EQ(glb.document["nodes"][0]["translation"][0], 1e9 + 1.0);
    EXPECT_EQ(glb.at<float>("POSITION", 1)[0] - glb.at<float>("POSITION", 0)[0], 2.0F);
}

std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(UsdaWriter, SaysPointsFacesNormalsAndAttributes) {
    const TemporaryDirectory directory;
    formats::write_usda(directory / "a.usda", attributed_tetrahedron());
    const std::string text = text_of(directory / "a.usda");
    const char* const normals =
        "    normal3f[] normals = [(-1, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)] (\n        interpolation = "
        "\"vertex\"\n";
    for (const char* line : {
             "#usda 1.0\n",
             "    point3f[] points = [(0, 0, 0), (2, 0, 0), (0, 4, 0), (0, 0, 6)]\n",
             "    int[] faceVertexCounts = [3, 3, 3, 3]\n",
             "    int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]\n",
             normals,
             "    vector3f[] velocities = [(0, 1, 2), (3, 4, 5), (6, 7, 8), (9, 10, 11)]\n",
             "    float[] primvars:age = [0.5, 1.5, 2.5, 3.5] (\n",
             "    uchar[] primvars:phase = [0, 1, 2, 255] (\n",
             "    int[] primvars:id = [-7, 0, 5, 16777216] (\n",
             "    uint[] primvars:far = [1, 2, 3, 4000000001] (\n",
         })
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST(UsdaWriter, AStageOfClipsNamesEveryFrameWithItsTime) {
    const TemporaryDirectory directory;
    std::vector<formats::UsdaClip> clips;
    for (const int frame : {20, 21}) {
        clips.push_back({static_cast<double>(frame), directory / ("mesh_" + std::to_string(frame) + ".usda")});
        formats::write_usda(clips.back().file, attributed_tetrahedron(), {.time = clips.back().time});
    }
    const std::string frame = text_of(clips[1].file);
    EXPECT_NE(frame.find("point3f[] points.timeSamples = {\n        21: [(0, 0, 0)"), std::string::npos) << frame;
    formats::write_usda_clips(directory / "all.usda", clips, attributed_tetrahedron());
    const std::string stage = text_of(directory / "all.usda");
    for (const char* line : {
             "    startTimeCode = 20\n    endTimeCode = 21\n",
             "asset[] assetPaths = [@@@./mesh_20.usda@@@, @@@./mesh_21.usda@@@]\n",
             "string primPath = \"/surface\"\n",
             "double2[] active = [(20, 0), (21, 1)]\n",
             "double2[] times = [(20, 20), (21, 21)]\n",
             "    point3f[] points\n    int[] faceVertexCounts\n",
             "    float[] primvars:age (\n",
         })
        EXPECT_NE(stage.find(line), std::string::npos) << line << stage;
}

TEST(UsdaWriter, NamesBeginWithNoDigitAndStayDistinct) {
    const TemporaryDirectory directory;
    TriangleMesh mesh = attributed_tetrahedron();
    mesh.attributes.clear();
    for (const char* name : {"2nd", "_2nd", "__2nd", "_second", "second_2"})
        mesh.attributes.push_back(values_of<float>(name, ElementType::float32, 1, {1, 2, 3, 4}));
    formats::write_usda(directory / "a.usda", mesh);
    formats::write_usda_clips(directory / "all.usda", {}, mesh);
    for (const std::string& text : {text_of(directory / "a.usda"), text_of(directory / "all.usda")}) {
        for (const char* name : {"_2nd", "__2nd", "___2nd", "_second", "second_2"})
            EXPECT_NE(text.find("    float[] primvars:" + std::string(name) + ' '), std::string::npos) << name << text;
        EXPECT_EQ(text.find("primvars:2nd"), std::string::npos) << text;
    }
}

TEST(UsdaWriter, AStageMayLieInTheCurrentFolder) {
    const TemporaryDirectory directory;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(directory.path());
    const std::array clips{formats::UsdaClip{3.0, "meshes/mesh_3.usda"}};
    EXPECT_NO_THROW(formats::write_usda_clips("all.usda", clips, attributed_tetrahedron()));
    std::filesystem::current_path(before);
    EXPECT_NE(text_of(directory / "all.usda").find("[@@@./meshes/mesh_3.usda@@@]"), std::string::npos);
}

TEST(UsdaWriter, AMeshFarAwayIsPutInPlaceByATranslation) {
    const TemporaryDirectory directory;
    TriangleMesh mesh = attributed_tetrahedron();
    for (auto& p : mesh.positions) p[0] += 1e9;
    mesh.wide = true;
    formats::write_usda(directory / "a.usda", mesh);
    const std::string text = text_of(directory / "a.usda");
    EXPECT_NE(text.find("double3 xformOp:translate = (1000000001, 2, 3)\n"), std::string::npos) << text;
    EXPECT_NE(text.find("points = [(-1, -2, -3), (1, -2, -3)"), std::string::npos) << text;
}

}  // namespace
}  // namespace meniscus::test
