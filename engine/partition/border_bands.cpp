#include "partition/border_bands.h"

#include "runtime/parallel.h"
#include "runtime/per_thread.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace quadseg::partition {

namespace {

/// A face with an edge on the border between two labels.
struct BorderFace {
    std::int32_t a, b;
    std::uint32_t face;
    auto key() const { return std::tie(a, b, face); }
};

std::vector<BorderFace> border_faces(const Passage& passage, const Labels& labels, const runtime::RunControl& control) {
    constexpr std::size_t grain = 8192;
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<BorderFace>& part) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g < 0 || labels[static_cast<std::size_t>(g)] == labels[f]) continue;
                const auto [a, b] = std::minmax(labels[f], labels[static_cast<std::size_t>(g)]);
                part.push_back({a, b, static_cast<std::uint32_t>(f)});
            }
        }
    };
    std::vector<BorderFace> all = runtime::collect_blocks<BorderFace>(labels.size(), grain, find);
    runtime::parallel_sort(all.begin(), all.end(),
                           [](const BorderFace& x, const BorderFace& y) { return x.key() < y.key(); });
    all.erase(std::unique(all.begin(), all.end(),
                          [](const BorderFace& x, const BorderFace& y) { return x.key() == y.key(); }),
              all.end());
    return all;
}

/// Faces within `width` of the seeds, in rings across edges, each within its own region.
std::vector<std::uint32_t> grow_band(const Passage& passage, const Labels& labels, std::vector<std::uint32_t> band,
                                     int width, std::vector<std::uint8_t>& marked) {
    for (const std::uint32_t f : band) marked[f] = 1;
    std::size_t ring = 0;
    for (int depth = 1; depth < width; ++depth) {
        const std::size_t end = band.size();
        for (; ring < end; ++ring) {
            const std::uint32_t f = band[ring];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g < 0 || marked[static_cast<std::size_t>(g)] != 0) continue;
                if (labels[static_cast<std::size_t>(g)] != labels[f]) continue;
                marked[static_cast<std::size_t>(g)] = 1;
                band.push_back(static_cast<std::uint32_t>(g));
            }
        }
    }
    for (const std::uint32_t f : band) marked[f] = 0;
    std::sort(band.begin(), band.end());
    return band;
}

/// Pairs that share or touch a face of their bands.
std::vector<std::pair<std::uint32_t, std::uint32_t>> conflicts(const Passage& passage, const BorderBands& bands) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> users;  // (face, pair)
    for (std::uint32_t i = 0; i < bands.pairs.size(); ++i) {
        for (std::uint32_t j = bands.begin[i]; j < bands.begin[i + 1]; ++j) {
            users.emplace_back(bands.face[j], i);
            for (const std::int32_t g : passage.mesh->neighbors[bands.face[j]]) {
                if (g >= 0) users.emplace_back(static_cast<std::uint32_t>(g), i);
            }
        }
    }
    runtime::parallel_sort(users.begin(), users.end(), std::less<>());
    users.erase(std::unique(users.begin(), users.end()), users.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> result;  // (later, earlier)
    for (std::size_t begin = 0, end = 0; begin < users.size(); begin = end) {
        while (end < users.size() && users[end].first == users[begin].first) ++end;
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t j = begin; j < i; ++j) result.emplace_back(users[i].second, users[j].second);
        }
    }
    runtime::parallel_sort(result.begin(), result.end(), std::less<>());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

/// Each pair, in order, takes the first batch without a conflict.
void find_batches(const Passage& passage, BorderBands& bands) {
    const auto against = conflicts(passage, bands);
    std::vector<std::uint32_t> batch(bands.pairs.size(), 0);
    std::vector<std::uint32_t> taken;
    std::uint32_t batches = 0;
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < bands.pairs.size(); ++i) {
        taken.clear();
        for (; next < against.size() && against[next].first == i; ++next) taken.push_back(batch[against[next].second]);
        std::sort(taken.begin(), taken.end());
        std::uint32_t free = 0;
        for (const std::uint32_t t : taken) free += t == free ? 1U : 0U;
        batch[i] = free;
        batches = std::max(batches, free + 1);
    }
    bands.batch_begin.assign(batches + 1, 0);
    for (const std::uint32_t b : batch) ++bands.batch_begin[b];
    runtime::exclusive_scan(bands.batch_begin);
    bands.batch_pair.resize(batch.size());
    std::vector<std::uint32_t> at(bands.batch_begin.begin(), bands.batch_begin.end() - 1);
    for (std::uint32_t i = 0; i < batch.size(); ++i) bands.batch_pair[at[batch[i]]++] = i;
}

}  // namespace

BorderBands find_border_bands(const Passage& passage, const Labels& labels, int width,
                              const runtime::RunControl& control) {
    const std::vector<BorderFace> seeds = border_faces(passage, labels, control);
    BorderBands bands;
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        if (i > 0 && seeds[i].a == seeds[i - 1].a && seeds[i].b == seeds[i - 1].b) continue;
        first.push_back(i);
        bands.pairs.push_back({seeds[i].a, seeds[i].b});
    }
    first.push_back(seeds.size());
    std::vector<std::vector<std::uint32_t>> grown(bands.pairs.size());
    runtime::PerThread<std::vector<std::uint8_t>> marks;
    runtime::parallel_for(bands.pairs.size(), 4, [&](std::size_t i) {
        control.check();
        std::vector<std::uint8_t>& marked = marks.local();
        if (marked.empty()) marked.assign(labels.size(), 0);
        std::vector<std::uint32_t> band;
        band.reserve(2 * (first[i + 1] - first[i]));
        for (std::size_t j = first[i]; j < first[i + 1]; ++j) band.push_back(seeds[j].face);
        grown[i] = grow_band(passage, labels, std::move(band), width, marked);
    });
    bands.begin.assign(1, 0);
    for (const auto& band : grown) {
        bands.face.insert(bands.face.end(), band.begin(), band.end());
        bands.begin.push_back(static_cast<std::uint32_t>(bands.face.size()));
    }
    control.check();
    find_batches(passage, bands);
    return bands;
}

}  // namespace quadseg::partition
