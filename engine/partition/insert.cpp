#include "partition/insert.h"

#include <algorithm>

namespace quadseg::partition {

namespace {

/// Faces below this share of the mean area of their region are no seeds of new regions.
constexpr double sliver_share = 0.01;

std::uint64_t splitmix64(std::uint64_t x) noexcept {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

}  // namespace

RandomNumbers::RandomNumbers(std::uint64_t seed) noexcept : state_(splitmix64(seed)) {}

std::uint32_t RandomNumbers::next() noexcept {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + 1442695040888963407ULL;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
}

std::uint32_t RandomNumbers::below(std::uint32_t bound) noexcept {
    const std::uint32_t threshold = (0U - bound) % bound;
    for (;;) {
        const std::uint32_t r = next();
        if (r >= threshold) return r % bound;
    }
}

std::vector<std::uint32_t> random_seeds(const mesh::WorkMesh& mesh, const Labels& groups, std::size_t group_count,
                                        std::size_t count, std::uint64_t seed) {
    // Reservoir of one per group: a random face with area, or the first face where no face has any.
    RandomNumbers random(seed);
    std::vector<std::uint32_t> seeds(group_count, 0), seen(group_count, 0);
    std::vector<std::uint8_t> known(group_count, 0);
    for (std::size_t f = 0; f < groups.size(); ++f) {
        const auto g = static_cast<std::size_t>(groups[f]);
        if (known[g] == 0) seeds[g] = static_cast<std::uint32_t>(f);
        known[g] = 1;
        if (!(mesh.areas[f] > 0)) continue;
        if (random.below(++seen[g]) == 0) seeds[g] = static_cast<std::uint32_t>(f);
    }
    if (count > group_count) {
        std::vector<std::uint8_t> taken(groups.size(), 0);
        for (const std::uint32_t s : seeds) taken[s] = 1;
        std::vector<std::uint32_t> rest;
        for (std::size_t f = 0; f < groups.size(); ++f) {
            if (taken[f] == 0 && mesh.areas[f] > 0) rest.push_back(static_cast<std::uint32_t>(f));
        }
        const std::size_t more = std::min(count - group_count, rest.size());
        for (std::size_t i = 0; i < more; ++i) {  // the first `more` steps of a Fisher–Yates shuffle
            std::swap(rest[i], rest[i + random.below(static_cast<std::uint32_t>(rest.size() - i))]);
        }
        seeds.insert(seeds.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(more));
    }
    std::sort(seeds.begin(), seeds.end());
    return seeds;
}

std::uint32_t best_face(const mesh::WorkMesh& mesh, std::span<const std::uint32_t> faces,
                        const std::vector<double>& density, std::optional<std::uint32_t> except) {
    std::optional<std::uint32_t> best;
    const auto better = [&](std::uint32_t a, std::uint32_t b) {
        const bool solid_a = mesh.areas[a] > 0, solid_b = mesh.areas[b] > 0;
        if (solid_a != solid_b) return solid_a;
        return density[a] != density[b] ? density[a] < density[b] : a < b;
    };
    for (const std::uint32_t f : faces) {
        if (except == f) continue;
        if (!best || better(f, *best)) best = f;
    }
    return best.value_or(faces.front());
}

std::optional<std::uint32_t> worst_face(const mesh::WorkMesh& mesh, std::span<const std::uint32_t> faces,
                                        const std::vector<double>& density, std::uint32_t except) {
    double area = 0;
    for (const std::uint32_t f : faces) area += mesh.areas[f];
    const double sliver = sliver_share * area / static_cast<double>(std::max<std::size_t>(faces.size(), 1));
    std::optional<std::uint32_t> worst;
    const auto worse = [&](std::uint32_t a, std::uint32_t b) {
        const bool solid_a = mesh.areas[a] > sliver, solid_b = mesh.areas[b] > sliver;
        if (solid_a != solid_b) return solid_a;
        return density[a] != density[b] ? density[a] > density[b] : a < b;
    };
    for (const std::uint32_t f : faces) {
        if (f == except) continue;
        if (!worst || worse(f, *worst)) worst = f;
    }
    return worst;
}

std::vector<double> smoothed_density(const Passage& passage, std::span<const std::uint32_t> faces, const Labels& labels,
                                     const std::vector<double>& density, int rounds) {
    const std::vector<double>& areas = passage.mesh->areas;
    std::vector<double> smooth = density, next(faces.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const std::size_t f = faces[i];
            double weight = areas[f], sum = areas[f] * smooth[f];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g == mesh::no_face || labels[static_cast<std::size_t>(g)] != labels[f]) continue;
                weight += areas[static_cast<std::size_t>(g)];
                sum += areas[static_cast<std::size_t>(g)] * smooth[static_cast<std::size_t>(g)];
            }
            next[i] = weight > 0 ? sum / weight : 0;
        }
        for (std::size_t i = 0; i < faces.size(); ++i) smooth[faces[i]] = next[i];
    }
    return smooth;
}

std::vector<std::uint32_t> farthest_regions(std::span<const InsertionCandidate> regions) {
    std::vector<std::uint32_t> order;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (regions[r].faces > 1) order.push_back(static_cast<std::uint32_t>(r));
    }
    const auto density = [&](std::uint32_t r) { return regions[r].area > 0 ? regions[r].energy / regions[r].area : 0; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (regions[a].valid != regions[b].valid) return regions[b].valid;
        return density(a) != density(b) ? density(a) > density(b) : a < b;
    });
    return order;
}

}  // namespace quadseg::partition
