// What a simulation that uses the library looks like to its build: no gRPC, no Draco. No server is there.
#include <cstdio>
#include <meniscus/client/client.hpp>

int main() {
    using namespace meniscus::client;
    try {
        Client client("127.0.0.1:1");
        meniscus::Settings settings;
        settings.particle_radius = 0.01;
        client.create_session(new_session_id(), settings);
    } catch (const ServerError& error) {
        std::puts(error.what());
        return 0;
    }
    return 1;
}
