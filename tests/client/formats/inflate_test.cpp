// Decompression: what is whole is read, whatever its size; what is cut is not.
#include "formats/bytes/inflate.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "formats/containers/npy.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "formats/particles/particle_readers.hpp"
#include "hostile/crafted_zip.hpp"
#include "hostile/deflating.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

const formats::ByteCursor inflating("f", {});

/// As numpy.savez_compressed() writes them.
std::string compressed_zeros(std::uint64_t bytes, int window = Deflating::raw) {
    Deflating content(window);
    content.zeros(bytes);
    return content.finish();
}

void expect_whole(std::uint64_t zeros) {
    const std::string bytes = compressed_zeros(zeros);
    std::string out;
    const std::string message =
        refusal([&] { out = formats::inflate(inflating, bytes, formats::Deflate::raw, zeros, "member"); });
    ASSERT_EQ(message, "") << zeros;
    ASSERT_EQ(out.size(), zeros);
    ASSERT_EQ(out.find_first_not_of('\0'), std::string::npos) << zeros;
}

TEST(Inflate, ZerosOfAnySizeAreWhole) {
    // zlib holds back what fills no byte: where a piece of the output is full, there may be no input left. Sizes as of
    // float32, around multiples of the piece; large ones at places where that happened.
    for (std::int64_t k = 1; k <= 64; ++k)
        for (std::int64_t d = -64; d <= 1000; d += 8)
            if (k <= 4 || d == 16 || d == 8 * (k % 8)) expect_whole(static_cast<std::uint64_t>(4 * (k * 65'536 + d)));
}

TEST(Inflate, ZipsOfZerosAreReadAsParticlesAndAsMeshes) {
    for (std::uint64_t count = 29 * 65'536 - 64; count <= 29 * 65'536 + 64; count += 8) {
        const auto member = [](const char* type, const std::vector<std::size_t>& shape, std::uint64_t bytes) {
            auto content = std::make_unique<Deflating>(Deflating::raw);
            content->add(formats::npy_header(type, shape));
            content->zeros(bytes);
            return content;
        };
        const auto positions = member("<f4", {1, 3}, 12), triangles = member("<u4", {1, 3}, 12),
                   zeros = member("<f4", {count}, 4 * count);
        const std::string bytes = crafted_zip(
            {{"positions.npy", positions.get()}, {"triangles.npy", triangles.get()}, {"q.npy", zeros.get()}});
        EXPECT_EQ(refusal([&] { EXPECT_EQ(formats::read_npz("f", bytes).count(), 1U); }), "") << count;
        EXPECT_EQ(refusal([&] { EXPECT_EQ(formats::read_mesh_npz("f", bytes).triangles.size(), 1U); }), "") << count;
    }
}

TEST(Inflate, BytesThatAreCutAreRefusedWhereverTheyAreCut) {
    for (const auto& way :
         {std::pair{Deflating::raw, formats::Deflate::raw}, {Deflating::gzip, formats::Deflate::gzip}}) {
        const std::string bytes = compressed_zeros(1'000'000, way.first);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const std::string message = refusal([&] {
                formats::inflate(inflating, std::string_view(bytes).substr(0, size), way.second, 2'000'000, "member");
            });
            ASSERT_EQ(message, "f: truncated: member ends before its compressed data do") << size;
        }
    }
}

}  // namespace
}  // namespace meniscus::test
