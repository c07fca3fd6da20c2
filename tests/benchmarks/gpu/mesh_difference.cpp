#include "gpu/mesh_difference.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <sstream>

namespace meniscus::benchmarks {
namespace {

template <class T, std::size_t N>
void print(std::ostream& out, const std::array<T, N>& numbers) {
    out.precision(9);
    for (const T number : numbers) out << ' ' << number;
}
void print(std::ostream& out, const TriangleRange& range) {
    out << ' ' << range.first << " + " << range.count;
}
void print(std::ostream& out, const MeshBrick& brick) {
    print(out, brick.coordinate);
    for (const TriangleRange& range : brick.ranges) {
        out << " |";
        print(out, range);
    }
}

template <class Elements>
void compare(const char* name, const Elements& cpu, const Elements& gpu, MeshDifference& found) {
    const std::size_t both = std::min(cpu.size(), gpu.size());
    constexpr std::size_t bytes = sizeof(cpu[0]);
    const auto bytes_of = [](const auto& element) { return std::bit_cast<std::array<std::byte, bytes>>(element); };
    std::size_t first = both;
    std::size_t different = 0;
    if (both != 0 && std::memcmp(cpu.data(), gpu.data(), both * bytes) != 0)
        for (std::size_t i = 0; i < both; ++i)
            if (bytes_of(cpu[i]) != bytes_of(gpu[i])) {
                first = std::min(first, i);
                ++different;
            }
    different += std::max(cpu.size(), gpu.size()) - both;
    found.count += different;
    if (different == 0 || !found.first.empty()) return;
    std::ostringstream text;
    text << name << " (" << cpu.size() << " on the CPU; " << gpu.size() << " on the GPU): " << different
         << " differ; the first is " << first << ": CPU";
    const auto print_element = [&](const Elements& of) {
        if (first < of.size())
            print(text, of[first]);
        else
            text << " has none";
    };
    print_element(cpu);
    text << "; GPU";
    print_element(gpu);
    found.first = text.str();
}

}  // namespace

MeshDifference find_difference(const Mesh& cpu, const Mesh& gpu) {
    MeshDifference found;
    compare("vertices", cpu.vertices, gpu.vertices, found);
    compare("normals", cpu.normals, gpu.normals, found);
    compare("triangles", cpu.triangles, gpu.triangles, found);
    compare("levels", cpu.levels, gpu.levels, found);
    compare("bricks", cpu.bricks, gpu.bricks, found);
    compare("spray", cpu.spray, gpu.spray, found);
    return found;
}

}  // namespace meniscus::benchmarks
