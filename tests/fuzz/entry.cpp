// The function that libFuzzer calls, for the target that the build names.
#include <google/protobuf/stubs/logging.h>

#include <cstddef>
#include <cstdint>

#include "targets.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
    google::protobuf::SetLogHandler(nullptr);
    return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    meniscus::fuzz::MENISCUS_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
