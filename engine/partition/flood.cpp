#include "partition/flood.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace quadseg::partition {

namespace {

constexpr std::size_t arity = 4;

/// Non-negative floats order like their bits.
std::uint64_t queue_entry(float priority, std::size_t face) noexcept {
    return std::uint64_t{std::bit_cast<std::uint32_t>(priority)} << 32U | static_cast<std::uint32_t>(face);
}

float priority_of(double density) noexcept {
    return static_cast<float>(std::min(density, double{std::numeric_limits<float>::max()}));
}

}  // namespace

void Flood::Queue::push(std::uint64_t entry) {
    std::size_t at = heap_.size();
    heap_.push_back(entry);
    while (at > 0) {
        const std::size_t parent = (at - 1) / arity;
        if (heap_[parent] <= entry) break;
        heap_[at] = heap_[parent];
        at = parent;
    }
    heap_[at] = entry;
}

std::uint64_t Flood::Queue::pop() {
    const std::uint64_t top = heap_.front();
    const std::uint64_t last = heap_.back();
    heap_.pop_back();
    const std::size_t size = heap_.size();
    if (size == 0) return top;
    std::size_t at = 0;
    for (;;) {
        const std::size_t first = at * arity + 1;
        if (first >= size) break;
        std::size_t least = first;
        const std::size_t end = std::min(first + arity, size);
        for (std::size_t child = first + 1; child < end; ++child) {
            if (heap_[child] < heap_[least]) least = child;
        }
        if (heap_[least] >= last) break;
        heap_[at] = heap_[least];
        at = least;
    }
    heap_[at] = last;
    return top;
}

Flood::Flood(const Passage& passage) : passage_(passage), offers_(passage.mesh->face_count(), Offer{0, 0, closed}) {}

void Flood::grow(std::size_t face, std::size_t region, float priority, std::span<const SeededRegion> regions,
                 const FaceMetric& metric, const Labels& labels, const std::vector<double>& density) {
    const mesh::WorkMesh& mesh = *passage_.mesh;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t neighbor = passage_.across(face, k);
        if (neighbor == mesh::no_face) continue;
        const auto u = static_cast<std::size_t>(neighbor);
        Offer& offer = offers_[u];
        const auto index = static_cast<std::int32_t>(region);
        if (offer.region == closed || offer.region == index) continue;
        Offer mine;
        mine.region = index;
        if (mesh.areas[u] > 0) {
            const SeededRegion& r = regions[region];
            mine.density = labels[u] == r.label ? density[u] : error_density(mesh, u, *r.proxy, metric);
            mine.priority = priority_of(mine.density);
        } else {
            // A face without area has no error of its own: it is neither a wall nor a short cut.
            mine.priority = priority;
        }
        if (offer.region < 0 || mine.priority < offer.priority) {
            queue_.push(queue_entry(mine.priority, u));
            offer = mine;
        } else if (mine.priority == offer.priority &&
                   regions[region].label < regions[static_cast<std::size_t>(offer.region)].label) {
            offer = mine;
        }
    }
}

void Flood::run(std::span<const SeededRegion> regions, std::span<const std::uint32_t> faces, const FaceMetric& metric,
                Labels& labels, std::vector<double>& density, const runtime::RunControl& control) {
    constexpr std::size_t poll_interval = 4096;
    queue_.clear();
    // What is left open by an exception or by an unreachable face must not be open to the next flood.
    const auto close = [&] {
        for (const std::uint32_t f : faces) offers_[f].region = closed;
    };
    try {
        for (const std::uint32_t f : faces) offers_[f] = Offer{};
        for (const SeededRegion& r : regions) {
            const std::size_t seed = r.seed;
            offers_[seed].region = closed;
            if (labels[seed] != r.label) density[seed] = error_density(*passage_.mesh, seed, *r.proxy, metric);
            labels[seed] = r.label;
        }
        for (std::size_t i = 0; i < regions.size(); ++i) {
            const std::size_t seed = regions[i].seed;
            grow(seed, i, priority_of(density[seed]), regions, metric, labels, density);
        }
        std::size_t popped = 0;
        while (!queue_.empty()) {
            if (++popped % poll_interval == 0) control.check();
            const auto face = static_cast<std::size_t>(queue_.pop() & 0xFFFFFFFFU);
            Offer& offer = offers_[face];
            if (offer.region == closed) continue;
            const auto region = static_cast<std::size_t>(offer.region);
            labels[face] = regions[region].label;
            density[face] = offer.density;
            offer.region = closed;
            grow(face, region, offer.priority, regions, metric, labels, density);
        }
    } catch (...) {
        close();
        throw;
    }
    close();
}

}  // namespace quadseg::partition
