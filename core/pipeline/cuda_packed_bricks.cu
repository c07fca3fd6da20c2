#include "pipeline/cuda_packed_bricks.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::cuda {
namespace {

/// The meaning of packed bytes depends on the ranges of their attributes.
void add_forms(const std::vector<CodedAttribute>& forms, WordHash& hash) {
    // Behind all words that a brick may have.
    std::uint64_t index = std::uint64_t{1} << 32;
    for (const CodedAttribute& form : forms) {
        hash.add(
            static_cast<std::uint64_t>(form.type) << 16 | form.components << 8 | static_cast<std::uint64_t>(form.bits),
            index++);
        for (std::size_t c = 0; c < form.components; ++c)
            hash.add(std::uint64_t{std::bit_cast<std::uint32_t>(form.minimum[c])} << 32 |
                         std::bit_cast<std::uint32_t>(form.maximum[c]),
                     index++);
    }
}

}  // namespace

DevicePackedBricks::DevicePackedBricks(std::shared_ptr<MeshStorage> storage, const MeshOnDevice& from, const Mesh& mesh,
                                       std::span<const BrickOnDevice> on_device, const CodingOptions& options,
                                       std::shared_ptr<CopyTime> time)
    : storage_(std::move(storage)),
      time_(std::move(time)),
      memory_(storage_->packing_memory()),
      bricks_(mesh.bricks.size()) {
    std::size_t attribute_bytes = 0;
    for (const CodedAttribute& form : options.attributes) attribute_bytes += form.coded_bytes();
    const int normal_bits = from.mesh.normals != nullptr ? options.normal_bits : 0;
    const int offset_bits = options.position_bits != 0 ? options.position_bits : static_cast<int>(mesh.offset_bits);
    std::uint64_t words = 0;
    for (std::size_t i = 0; i < bricks_.size(); ++i) {
        const KeptBrick& kept = on_device[i].kept;
        Brick& brick = bricks_[i];
        brick.coordinate = mesh.bricks[i].coordinate;
        brick.vertices = kept.totals.vertices;
        brick.triangles = mesh.bricks[i].triangle_count();
        brick.bytes = PackedPlaces(packed_counts(kept), offset_bits, normal_bits).attributes / 8 +
                      attribute_bytes * brick.vertices;
        brick.place = {
            .at = 8 * words, .brick = on_device[i].index, .words = static_cast<std::uint32_t>((brick.bytes + 7) / 8)};
        words += brick.place.words;
    }
    try {
        memory_->reserve(bricks_.size(), words);
        pack(from, mesh, {.normal_bits = normal_bits, .position_bits = offset_bits, .attributes = options.attributes},
             words);
    } catch (...) {
        storage_->stream.settle();
        give_back();
        throw;
    }
}

DevicePackedBricks::~DevicePackedBricks() {
    const std::lock_guard lock(storage_->copying);
    give_back();
}

void DevicePackedBricks::give_back() noexcept {
    try {
        storage_->to_pack_in.push_back(std::move(memory_));
    } catch (...) {
        // There is no memory to keep it: it is freed.
    }
}

void DevicePackedBricks::pack(const MeshOnDevice& from, const Mesh& mesh, const CodingOptions& options,
                              std::uint64_t words) {
    if (bricks_.empty()) return;
    cudaStream_t stream = storage_->stream.get();
    const auto count = static_cast<std::uint32_t>(bricks_.size());
    auto* const places = memory_->table<PackedPlace>();
    std::ranges::transform(bricks_, places, &Brick::place);
    check(cudaMemcpyAsync(memory_->places, places, count * sizeof(PackedPlace), cudaMemcpyHostToDevice, stream),
          "cudaMemcpyAsync");
    check(cudaMemsetAsync(memory_->words, 0, words * sizeof(std::uint64_t), stream), "cudaMemsetAsync");
    const PackedForm form{.offset_bits = options.position_bits, .normal_bits = options.normal_bits};
    auto* const out = reinterpret_cast<std::byte*>(memory_->words);
    pack_bricks(from.lattice, form, memory_->places, count, out, storage_->launch);
    std::uint32_t bytes_before = 0;
    for (const CodedAttribute& coded : options.attributes) {
        const auto a = std::ranges::find(mesh.attributes, coded.name, &MeshAttribute::name) - mesh.attributes.begin();
        const AttributeOnDevice attribute(
            coded, static_cast<const std::byte*>(from.mesh.attributes[static_cast<std::size_t>(a)].data));
        pack_attribute(from.lattice, form, attribute, bytes_before, memory_->places, count, out, storage_->launch);
        bytes_before += attribute.coded_bytes;
    }
    hash_packed_bricks(memory_->places, count, out, memory_->hashes, storage_->launch);
    // In the place of the other table, which has gone by then.
    auto* const hashes = memory_->table<WordHash>();
    check(cudaMemcpyAsync(hashes, memory_->hashes, count * sizeof(WordHash), cudaMemcpyDeviceToHost, stream),
          "cudaMemcpyAsync");
    storage_->stream.synchronize();
    memory_->require_whole_guards();
    for (std::size_t i = 0; i < bricks_.size(); ++i) {
        bricks_[i].hash = hashes[i];
        add_forms(options.attributes, bricks_[i].hash);
    }
}

DeviceBytes DevicePackedBricks::on_device(std::size_t number) const {
    const Brick& brick = bricks_[number];
    return {reinterpret_cast<const std::byte*>(memory_->words) + brick.place.at, brick.bytes, storage_->device};
}

std::vector<DevicePackedBrick> DevicePackedBricks::all() const {
    std::vector<DevicePackedBrick> all;
    all.reserve(bricks_.size());
    for (std::size_t i = 0; i < bricks_.size(); ++i)
        all.push_back({.coordinate = bricks_[i].coordinate,
                       .vertices = bricks_[i].vertices,
                       .triangles = bricks_[i].triangles,
                       .hash = hash(i),
                       .bytes = on_device(i)});
    return all;
}

void DevicePackedBricks::leave(std::size_t brick) {
    const std::lock_guard lock(storage_->copying);
    bricks_[brick].is_left = true;
}

EncodedBrick DevicePackedBricks::bring(std::size_t number) {
    const Brick& brick = bricks_[number];
    {
        const std::lock_guard lock(storage_->copying);
        if (error_) std::rethrow_exception(error_);
        if (!brick.is_here) fetch_from(number);
    }
    EncodedBrick encoded;
    encoded.coordinate = brick.coordinate;
    encoded.codec = Codec::lattice_packed;
    encoded.vertices = brick.vertices;
    encoded.triangles = brick.triangles;
    const std::byte* const begin = memory_->packed() + brick.place.at;
    encoded.data.assign(begin, begin + brick.bytes);
    return encoded;
}

void DevicePackedBricks::fetch_from(std::size_t first) {
    const std::uint64_t begin = bricks_[first].place.at;
    std::uint64_t end = begin;
    std::size_t last = first;
    do {
        end = bricks_[last].place.at + 8 * std::uint64_t{bricks_[last].place.words};
        ++last;
    } while (last < bricks_.size() && end - begin < fetch_bytes_ && !bricks_[last].is_left && !bricks_[last].is_here);
    const CopyTime::Span span(*time_);
    try {
        const CurrentDevice current(storage_->device);
        check(cudaMemcpyAsync(memory_->packed() + begin, reinterpret_cast<const std::byte*>(memory_->words) + begin,
                              end - begin, cudaMemcpyDeviceToHost, storage_->stream.get()),
              "cudaMemcpyAsync");
        storage_->stream.synchronize();
    } catch (...) {
        storage_->stream.settle();
        error_ = std::current_exception();
        throw;
    }
    for (std::size_t i = first; i < last; ++i) bricks_[i].is_here = true;
    fetch_bytes_ = std::min(2 * fetch_bytes_, most_fetch_bytes);
}

}  // namespace meniscus::cuda
