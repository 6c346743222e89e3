#include "flow/project_labels.h"

#include <algorithm>
#include <vector>

namespace quadseg::flow {

namespace {

constexpr std::int32_t unlabelled = -1;

/// Takes the label off every part that is too small to stand beside the largest part of its label.
void drop_small_parts(const partition::Passage& passage, partition::Labels& labels, double independent_share) {
    partition::Labels parts = labels;
    const std::size_t part_count = partition::connected_parts(passage, parts);
    std::vector<double> area(part_count, 0);
    std::vector<std::int32_t> label_of(part_count, unlabelled);
    std::int32_t largest_label = -1;
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (parts[f] < 0) continue;
        const auto p = static_cast<std::size_t>(parts[f]);
        area[p] += passage.mesh->areas[f];
        label_of[p] = labels[f];
        largest_label = std::max(largest_label, labels[f]);
    }
    std::vector<std::int32_t> largest_part(static_cast<std::size_t>(largest_label + 1), -1);
    for (std::size_t p = 0; p < part_count; ++p) {
        std::int32_t& best = largest_part[static_cast<std::size_t>(label_of[p])];
        if (best < 0 || area[p] > area[static_cast<std::size_t>(best)]) best = static_cast<std::int32_t>(p);
    }
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (parts[f] < 0) continue;
        const auto p = static_cast<std::size_t>(parts[f]);
        const auto best = static_cast<std::size_t>(largest_part[static_cast<std::size_t>(label_of[p])]);
        // Parts are regions from here on: connected, each under its own number.
        labels[f] = p == best || area[p] >= independent_share * area[best] ? parts[f] : unlabelled;
    }
}

/// Waves from the labelled faces inwards; a face takes the label of the neighbour whose normal is nearest to its own.
void flood_unlabelled(const partition::Passage& passage, partition::Labels& labels,
                      const runtime::RunControl& control) {
    const mesh::WorkMesh& mesh = *passage.mesh;
    std::vector<std::uint32_t> wave, next;
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] == unlabelled && passage.is_active(f)) wave.push_back(static_cast<std::uint32_t>(f));
    }
    std::vector<std::pair<std::uint32_t, std::int32_t>> taken;
    std::size_t counter = 0;
    while (!wave.empty()) {
        taken.clear();
        for (const std::uint32_t f : wave) {
            control.check_often(counter);
            std::int32_t best = unlabelled;
            double flattest = -2;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g < 0 || labels[static_cast<std::size_t>(g)] == unlabelled) continue;
                const std::int32_t label = labels[static_cast<std::size_t>(g)];
                const double cosine = dot(mesh.normals[f], mesh.normals[static_cast<std::size_t>(g)]);
                if (cosine > flattest || (cosine == flattest && label < best)) {
                    flattest = cosine;
                    best = label;
                }
            }
            if (best != unlabelled) taken.emplace_back(f, best);
        }
        for (const auto& [f, label] : taken) labels[f] = label;
        next.clear();
        for (const auto& [f, label] : taken) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g >= 0 && labels[static_cast<std::size_t>(g)] == unlabelled) {
                    next.push_back(static_cast<std::uint32_t>(g));
                }
            }
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        wave.swap(next);
    }
}

}  // namespace

partition::Labels project_labels(std::span<const std::int32_t> coarse_labels, std::span<const std::uint32_t> face_map) {
    partition::Labels labels(face_map.size(), unlabelled);
    for (std::size_t f = 0; f < face_map.size(); ++f) {
        if (face_map[f] < coarse_labels.size()) labels[f] = coarse_labels[face_map[f]];
    }
    return labels;
}

std::size_t connect_labels(const partition::Passage& passage, partition::Labels& labels, double independent_share,
                           const runtime::RunControl& control) {
    drop_small_parts(passage, labels, independent_share);
    flood_unlabelled(passage, labels, control);
    const auto highest = labels.empty() ? labels.end() : std::max_element(labels.begin(), labels.end());
    const std::int32_t fresh = labels.empty() ? 0 : *highest + 1;
    bool unreached = false;
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] != unlabelled || !passage.is_active(f)) continue;
        labels[f] = fresh;
        unreached = true;
    }
    // Waves leave parts connected: they need a number only, the one that connected_parts() would give.
    return unreached ? partition::connected_parts(passage, labels) : partition::compact(labels);
}

}  // namespace quadseg::flow
