// The driver's management library, with a library of ours in its place: no GPU is needed.
#include "engine/cuda/driver_memory.hpp"

#include <gtest/gtest.h>

namespace meniscus::cuda {
namespace {

TEST(DriverMemory, IsThatOfTheGpuAtThePlace) {
    const auto memory = driver_memory("0000:3b:00.0", MENISCUS_STAND_IN_FOR_NVML);
    ASSERT_TRUE(memory);
    EXPECT_EQ(memory->total_bytes, std::size_t{80} << 30);
    EXPECT_EQ(memory->free_bytes, std::size_t{60} << 30);
}

TEST(DriverMemory, IsNotToldWhereThereIsNoSuchGpu) {
    EXPECT_FALSE(driver_memory("0000:ff:00.0", MENISCUS_STAND_IN_FOR_NVML));
}

TEST(DriverMemory, IsNotToldByAGpuThatRefuses) {
    EXPECT_FALSE(driver_memory("0000:5e:00.0", MENISCUS_STAND_IN_FOR_NVML));
}

TEST(DriverMemory, IsNotToldWithoutTheLibrary) {
    EXPECT_FALSE(driver_memory("0000:3b:00.0", "libnot-there.so.1"));
    // A library without NVML's functions.
    EXPECT_FALSE(driver_memory("0000:3b:00.0", "libm.so.6"));
}

TEST(DriverMemory, StartsTheLibraryOnce) {
    // The stand-in refuses to answer once it has been started a second time.
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(driver_memory("0000:3b:00.0", MENISCUS_STAND_IN_FOR_NVML));
}

}  // namespace
}  // namespace meniscus::cuda
