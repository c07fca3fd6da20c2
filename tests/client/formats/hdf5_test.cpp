// HDF5: the forms in which programs keep particles, and files that lead to others.
#include <gtest/gtest.h>

#ifdef MENISCUS_HDF5
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "formats/particles/particle_file.hpp"
#include "hostile/hdf5_writing.hpp"
#include "hostile/other_files.hpp"
#include "sample_files.hpp"
#include "sample_values.hpp"

namespace meniscus::test {
namespace {

const std::vector<double> hdf5_rows{1, 2, 3, 4, 5, 6};
const std::vector<float> hdf5_points{1, 2, 3, 4, 5, 6};

class Hdf5 : public testing::Test {
protected:
    std::string said() const {
        return refusal([&] { formats::read_particles(path_); });
    }

    TemporaryDirectory directory_;
    std::filesystem::path path_ = directory_ / "f.h5";
};

TEST_F(Hdf5, PositionsInTheRootComeWithWhatElseHasARowForEach) {
    for (const char* name : {"positions", "Coordinates"}) {
        {
            const Hdf5Writing out(path_);
            out.set(name, hdf5_rows, {2, 3});
            out.set("velocity", {7, 8, 9, 10, 11, 12}, {2, 3}, H5T_IEEE_F32LE);
            out.set("id", {5, 6}, {2}, H5T_STD_I64BE);
            out.set("box", hdf5_rows, {3, 2});
            out.set("time", {0.5}, {1});
            out.group("about");
        }
        const formats::Particles particles = formats::read_particles(path_);
        EXPECT_EQ(particles.positions, hdf5_points) << name;
        ASSERT_EQ(particles.arrays.size(), 2U);
        EXPECT_EQ(particles.arrays[0].name, "id");
        EXPECT_EQ(particles.arrays[0].type, ElementType::int32);
        EXPECT_EQ(particles.arrays[1].name, "velocity");
        EXPECT_EQ(numbers_of<float>(particles.arrays[1]), (std::vector<float>{7, 8, 9, 10, 11, 12}));
    }
}

TEST_F(Hdf5, CoordinatesInTheRootMayBeInSetsOfTheirOwn) {
    {
        const Hdf5Writing out(path_);
        out.set("x", {1, 4}, {2});
        out.set("y", {2, 5}, {2});
        out.set("z", {3, 6}, {2});
        out.set("rho", {1000, 1001}, {2});
    }
    const formats::Particles particles = formats::read_particles(path_);
    EXPECT_EQ(particles.positions, hdf5_points);
    ASSERT_EQ(particles.arrays.size(), 1U);
    EXPECT_EQ(particles.arrays[0].name, "rho");
}

TEST_F(Hdf5, TheGasOfGadgetAndSwiftIsReadUnderUsualNames) {
    {
        const Hdf5Writing out(path_);
        for (const char* group : {"Header", "PartType0", "PartType1"}) out.group(group);
        out.set("PartType0/Coordinates", hdf5_rows, {2, 3});
        out.set("PartType0/Velocities", hdf5_rows, {2, 3}, H5T_IEEE_F32LE);
        out.set("PartType0/ParticleIDs", {7, 9}, {2}, H5T_STD_U64LE);
        out.set("PartType0/Density", {7, 9}, {2});
        out.set("PartType1/Coordinates", {0, 0, 0}, {1, 3});
    }
    const formats::Particles particles = formats::read_particles(path_);
    EXPECT_EQ(particles.positions, hdf5_points);
    ASSERT_EQ(particles.arrays.size(), 3U);
    EXPECT_EQ(particles.arrays[0].name, "density");
    EXPECT_EQ(particles.arrays[1].name, "id");
    EXPECT_EQ(particles.arrays[1].type, ElementType::uint32);
    EXPECT_EQ(particles.arrays[2].name, "velocity");
}

TEST_F(Hdf5, ARefusalNamesWhatWasLookedForAndWhatIsThere) {
    {
        const Hdf5Writing out(path_);
        out.set("pos", hdf5_rows, {2, 3});
    }
    for (const char* word : {"positions (N, 3)", "Coordinates", "x, y and z", "PartType0", "Step#0",
                             "particles/NAME/arrays", "its root has 'pos'"})
        EXPECT_NE(said().find(word), std::string::npos) << said();
    {
        const Hdf5Writing out(path_);
        out.set("positions", hdf5_rows, {3, 2});
    }
    EXPECT_NE(said().find("dataset 'positions' is no list of three coordinates each, of shape (N, 3)"),
              std::string::npos)
        << said();
}

TEST_F(Hdf5, LinksWithinTheFileAreFollowed) {
    {
        const Hdf5Writing out(path_);
        out.group("data");
        out.set("data/here", hdf5_rows, {2, 3});
        H5Lcreate_soft("/data/here", out.file(), "positions", 0, 0);
        H5Lcreate_hard(out.file(), "data/here", out.file(), "velocity", 0, 0);
        H5Lcreate_soft("/nowhere", out.file(), "dangling", 0, 0);
    }
    const formats::Particles particles = formats::read_particles(path_);
    EXPECT_EQ(particles.positions, hdf5_points);
    ASSERT_EQ(particles.arrays.size(), 1U);
    EXPECT_EQ(particles.arrays[0].name, "velocity");
}

TEST_F(Hdf5, FilesThatLeadToOthersAreRefusedBeforeAByteOfThoseIsRead) {
    const auto files = write_files_with_others(directory_.path());
    ASSERT_EQ(files.size(), 7U);
    for (const OtherFile& file : files) {
        SCOPED_TRACE(file.way);
        // One in a FIFO would never end.
        path_ = file.path;
        EXPECT_NE(said().find("in another file"), std::string::npos) << said();
        EXPECT_NE(said().find("only what a file holds itself is read"), std::string::npos) << said();
        // It is not looked for either.
        if (std::filesystem::is_regular_file(file.other)) {
            const std::filesystem::path away = file.other + "-away";
            const std::string before = said();
            std::filesystem::rename(file.other, away);
            EXPECT_EQ(said(), before);
            std::filesystem::rename(away, file.other);
        }
    }
}

TEST_F(Hdf5, AFilterThatTheLibraryDoesNotKnowIsRefusedAndNoLibraryLoadedForIt) {
    {
        const Hdf5Writing out(path_);
        const hid_t made = H5Pcreate(H5P_DATASET_CREATE);
        const std::array<hsize_t, 2> chunk{2, 3};
        H5Pset_chunk(made, 2, chunk.data());
        H5Pset_shuffle(made);
        out.set("positions", hdf5_rows, {2, 3}, H5T_IEEE_F64LE, made);
    }
    std::ifstream in(path_, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    // Eight bytes in front of a filter's name lies its number.
    const std::size_t number = bytes.find("shuffle") - 8;
    ASSERT_EQ(bytes.substr(number, 2), std::string("\x02\x00", 2));
    bytes.replace(number, 2, "\x0f\x7d");
    std::ofstream(path_, std::ios::binary) << bytes;
    H5PLprepend(MENISCUS_PLUGIN_FOLDER);
    EXPECT_NE(said().find("compressed by what this build of HDF5 does not know"), std::string::npos) << said();
    EXPECT_EQ(std::getenv("MENISCUS_PLUGIN_WAS_LOADED"), nullptr);
    unsigned loads = 0;
    H5PLget_loading_state(&loads);
    EXPECT_NE(loads, 0U) << "a program's own use of HDF5 is left as it was";
}

TEST_F(Hdf5, AChunkIsHeldAgainstTheLimitHoweverLittleOfItIsThere) {
    {
        const Hdf5Writing out(path_);
        const hid_t made = H5Pcreate(H5P_DATASET_CREATE);
        const std::array<hsize_t, 2> chunk{std::uint64_t{1} << 24U, 3}, shape{2, 3}, most{H5S_UNLIMITED, 3};
        H5Pset_chunk(made, 2, chunk.data());
        H5Pset_deflate(made, 9);
        const hid_t space = H5Screate_simple(2, shape.data(), most.data());
        H5Dclose(H5Dcreate2(out.file(), "positions", H5T_IEEE_F64LE, space, 0, made, 0));
        H5Sclose(space);
        H5Pclose(made);
    }
    const std::string message =
        refusal([&] { formats::read_particles(path_, std::nullopt, {.most_bytes = std::uint64_t{64} << 20U}); });
    EXPECT_NE(message.find("402653184 bytes for a chunk of dataset 'positions'"), std::string::npos) << message;
}

}  // namespace
}  // namespace meniscus::test
#endif
