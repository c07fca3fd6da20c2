// libcatalyst-meniscus.so without a server: surfaces as files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "catalyst_fixture.hpp"

namespace meniscus::test {
namespace {

class CatalystFiles : public Catalyst {
protected:
    CatalystFiles() {
        std::string folder = (std::filesystem::temp_directory_path() / "meniscus-XXXXXX").string();
        above_ = ::mkdtemp(folder.data());
    }
    ~CatalystFiles() override { std::filesystem::remove_all(above_); }

    std::string folder() const { return (above_ / "surfaces").string(); }
    std::string content(const std::string& name) const {
        std::ifstream file(std::filesystem::path(folder()) / name);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path above_;
};

TEST_F(CatalystFiles, HoldTheSurfacesOfAllFrames) {
    set_options("output=" + folder() + " particle-radius=0.025 policy=every-frame threads=1");
    testing::internal::CaptureStderr();
    ASSERT_EQ(initialize(), catalyst_status_ok);
    for (unsigned step = 0; step < 3; ++step)
        EXPECT_EQ(execute_frame(splash(step, 4), static_cast<std::int64_t>(step)), catalyst_status_ok);
    EXPECT_EQ(results().place, folder());
    EXPECT_EQ(results().sent, 3);
    EXPECT_EQ(finalize(), catalyst_status_ok);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(times(said, "surfaces of the ranks go to " + folder()), 1U) << said;
    const std::string list = content("surface.pvd");
    EXPECT_EQ(times(list, "<DataSet"), 3U);
    for (unsigned step = 0; step < 3; ++step) {
        const std::string file = "surface-00000" + std::to_string(step) + "-part-0.vtp";
        EXPECT_EQ(times(list, "file=\"" + file + "\""), 1U) << list;
        const Mesh whole = reconstruct(default_settings(), splash(step, 4).frame());
        EXPECT_EQ(times(content(file), "NumberOfPoints=\"" + std::to_string(whole.vertices.size()) + "\""), 1U);
        EXPECT_EQ(times(content(file), "NumberOfPolys=\"" + std::to_string(whole.triangles.size()) + "\""), 1U);
    }
    // What is there is not mixed with another run's.
    EXPECT_TRUE(refuses("output=" + folder() + " particle-radius=0.025", "surface.pvd is there: name a folder"));
}

TEST_F(CatalystFiles, RefuseOptionsOfServers) {
    for (const char* const option : {"session=6f1c2f0e-5a52-4a86-9c6b-0f8f5f0a4242", "timeout=3", "codec=draco"}) {
        const std::string name(option, std::string(option).find('='));
        EXPECT_TRUE(refuses("output=" + folder() + " particle-radius=0.025 " + option,
                            "option '" + name + "' is of servers, and 'output' writes files"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder()));
}

}  // namespace
}  // namespace meniscus::test
