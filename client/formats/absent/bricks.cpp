// A build without the service, whose messages .bricks consist of.
#include "formats/bytes/byte_cursor.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {
namespace {

constexpr const char* remedy = "build it without -DMENISCUS_SERVICE=OFF, where gRPC is installed";

}  // namespace

void write_bricks(const std::filesystem::path& /*path*/, const client::ReceivedFrame& /*frame*/) {
    throw NotBuilt("writing .bricks", std::string("the service: ") + remedy);
}

client::ReceivedFrame read_bricks(const std::string& name, std::string_view bytes) {
    ByteCursor(name, bytes).fail(std::string("this build reads no .bricks: ") + remedy);
}

}  // namespace meniscus::formats
