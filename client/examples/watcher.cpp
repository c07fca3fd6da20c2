// A watcher: receives the meshes of somebody's session, always the newest.
//
//   watcher HOST:PORT SESSION [FRAMES]        meniscus sessions --server HOST:PORT lists the sessions
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <meniscus/client/client.hpp>

int main(int argc, char** argv) try {
    using namespace std::chrono_literals;
    if (argc < 3) {
        std::fprintf(stderr, "usage: watcher HOST:PORT SESSION [FRAMES]\n");
        return 2;
    }
    const unsigned long frames = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0;  // 0: until the session ends

    meniscus::client::Client client(argv[1]);
    meniscus::client::Watcher watcher = client.watch(argv[2], {.reconnect = 60s});
    unsigned long received = 0;
    while (frames == 0 || received < frames) {
        const auto next = watcher.next(1s);
        if (next.ended) break;
        if (!next) {
            std::fprintf(stderr, "nothing new in a second\n");  // a program may look at its keyboard here
            continue;
        }
        // `changed` and `vanished` name the bricks that are not as they were: a renderer uploads no others.
        const meniscus::Mesh mesh = next->mesh();
        std::printf("frame %llu at %.1f s: %zu triangles, %zu of %zu bricks changed\n",
                    static_cast<unsigned long long>(next->index), next->simulation_time, mesh.triangles.size(),
                    next->changed.size(), next->bricks.size());
        ++received;
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
