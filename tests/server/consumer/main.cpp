// A simulation that uses the library, as its build sees it: no gRPC, no Draco. No server is there.
#include <cstdio>
#include <meniscus/client/client.hpp>
#include <vector>

int main() {
    using namespace meniscus::client;
    try {
        Client client("127.0.0.1:1");
        meniscus::Settings settings;
        settings.particle_radius = 0.01;
        Session session = client.open_session(settings, {.description = {.name = "dam"}});
        Stream stream = session.stream();
        const std::vector<double> positions(3);
        stream.push(meniscus::StridedPositions(positions), 0, 0.0);
    } catch (const ServerError& error) {
        std::puts(error.what());
        return code_of(error) == ErrorCode::unavailable ? 0 : 1;
    }
    return 1;
}
