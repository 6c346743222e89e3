#include "flow/curvature_patches.h"

#include "mesh/connected.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <unordered_map>

namespace quadseg::flow {

namespace {

constexpr std::size_t bins = 40;
constexpr double bin_width = 0.03;

/// The line along which two regions meet.
struct Border {
    std::uint32_t a = 0, b = 0;
    std::uint32_t version = 0;
    bool alive = true;
    double length = 0;
    double difference = 0;            ///< of curvatures, summed over the length
    std::array<float, bins> jumps{};  ///< length by relative jump

    void add(const CurvatureJump& jump, double edge_length) {
        const double bin = std::min(jump.relative / bin_width, static_cast<double>(bins - 1));
        jumps[static_cast<std::size_t>(bin)] += static_cast<float>(edge_length);
        length += edge_length;
        difference += jump.difference * edge_length;
    }
    void add(const Border& other) {
        for (std::size_t i = 0; i < bins; ++i) jumps[i] += other.jumps[i];
        length += other.length;
        difference += other.difference;
    }
    double median_jump() const {
        double total = 0;
        for (const float l : jumps) total += double(l);
        double below = 0;
        for (std::size_t i = 0; i < bins; ++i) {
            const double here = double(jumps[i]);
            if (here > 0 && below + here >= 0.5 * total) {
                return bin_width * (static_cast<double>(i) + (0.5 * total - below) / here);
            }
            below += here;
        }
        return 0;
    }
};

struct Patch {
    double area = 0;
    std::size_t faces = 0;
    std::vector<std::uint32_t> borders;  ///< some of them dead
};

struct Proposal {
    double cost;
    std::uint32_t border, version;
    friend bool operator<(const Proposal& x, const Proposal& y) {  // std::priority_queue: the largest first
        return x.cost != y.cost ? x.cost > y.cost : x.border > y.border;
    }
};

class Merger {
  public:
    Merger(std::vector<Patch> patches, const PatchRules& rules) : patches_(std::move(patches)), rules_(rules) {
        merged_into_.resize(patches_.size());
        for (std::size_t i = 0; i < merged_into_.size(); ++i) merged_into_[i] = static_cast<std::uint32_t>(i);
    }

    void add(std::uint32_t a, std::uint32_t b, const CurvatureJump& jump, double length) {
        const auto [at, fresh] = between_.try_emplace(key(a, b), static_cast<std::uint32_t>(borders_.size()));
        if (fresh) {
            Border border;
            border.a = a;
            border.b = b;
            borders_.push_back(border);
            patches_[a].borders.push_back(at->second);
            patches_[b].borders.push_back(at->second);
        }
        borders_[at->second].add(jump, length);
    }

    void run(const runtime::RunControl& control) {
        for (std::size_t i = 0; i < borders_.size(); ++i) propose(static_cast<std::uint32_t>(i));
        std::size_t polls = 0;
        while (!queue_.empty()) {
            control.check_often(polls);
            const Proposal best = queue_.top();
            queue_.pop();
            const Border& border = borders_[best.border];
            if (!border.alive || border.version != best.version) continue;
            // What regions gained since only makes a border dearer.
            if (cost(border) > best.cost) {
                propose(best.border);
            } else {
                merge(border.a, border.b);
            }
        }
    }

    std::uint32_t root(std::uint32_t patch) {
        while (merged_into_[patch] != patch) {
            merged_into_[patch] = merged_into_[merged_into_[patch]];
            patch = merged_into_[patch];
        }
        return patch;
    }

  private:
    static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    }

    double cost(const Border& border) const {
        const Patch &a = patches_[border.a], &b = patches_[border.b];
        const double area = std::min(a.area, b.area);
        const double width = border.length > 0 ? std::min(std::sqrt(area), area / border.length) : 0;
        const double turn = border.length > 0 ? border.difference / border.length * width : 0;
        const double faces = static_cast<double>(std::min(a.faces, b.faces)) / static_cast<double>(rules_.few_faces);
        return border.median_jump() * std::min(1.0, faces) *
               std::min(1.0, turn / (rules_.turn * std::numbers::pi / 180));
    }

    void propose(std::uint32_t id) {
        const double price = cost(borders_[id]);
        if (price <= rules_.jump) queue_.push({price, id, borders_[id].version});
    }

    /// Small-to-large in the number of borders.
    void merge(std::uint32_t keep, std::uint32_t gone) {
        if (patches_[keep].borders.size() < patches_[gone].borders.size()) std::swap(keep, gone);
        Patch& into = patches_[keep];
        Patch& from = patches_[gone];
        for (const std::uint32_t id : from.borders) {
            Border& border = borders_[id];
            if (!border.alive) continue;
            const std::uint32_t other = border.a == gone ? border.b : border.a;
            between_.erase(key(gone, other));
            if (other == keep) {
                border.alive = false;
                continue;
            }
            const auto [at, fresh] = between_.try_emplace(key(keep, other), id);
            if (fresh) {
                (border.a == gone ? border.a : border.b) = keep;
                into.borders.push_back(id);
            } else {
                borders_[at->second].add(border);
                border.alive = false;
            }
            changed_.push_back(at->second);
        }
        into.area += from.area;
        into.faces += from.faces;
        from.borders.clear();
        from.borders.shrink_to_fit();
        merged_into_[gone] = keep;
        for (const std::uint32_t id : changed_) {
            ++borders_[id].version;
            propose(id);
        }
        changed_.clear();
    }

    std::vector<Patch> patches_;
    PatchRules rules_;
    std::vector<Border> borders_;
    std::unordered_map<std::uint64_t, std::uint32_t> between_;  // looked up only: its order never shows
    std::vector<std::uint32_t> merged_into_, changed_;
    std::priority_queue<Proposal> queue_;
};

}  // namespace

partition::Labels curvature_patches(const mesh::WorkMesh& mesh, const mesh::FeatureEdges& creases,
                                    const CurvatureField& field, std::span<const std::uint8_t> wanted,
                                    const PatchRules& rules, const runtime::RunControl& control) {
    std::vector<std::int32_t> fragment;
    const std::size_t fragments = mesh::connected_faces(
        mesh, [&](std::size_t f) { return field.slot[f] >= 0 && wanted[f] != 0; },
        [&](std::size_t f, std::size_t k, std::size_t) {
            return (creases[f] >> k & 1) == 0 && curvature_jump(field, mesh, f, k).relative < rules.alike;
        },
        [&] { control.check(); }, fragment);
    std::vector<Patch> patches(fragments);
    for (const std::uint32_t f : field.face) {
        if (fragment[f] < 0) continue;
        Patch& patch = patches[static_cast<std::size_t>(fragment[f])];
        patch.area += mesh.areas[f];
        ++patch.faces;
    }
    Merger merger(std::move(patches), rules);
    std::size_t polls = 0;
    for (const std::uint32_t f : field.face) {
        control.check_often(polls);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = mesh.neighbors[f][k];  // every edge once, from its face of the lower number
            if (g <= static_cast<std::int32_t>(f) || fragment[f] < 0 || fragment[static_cast<std::size_t>(g)] < 0)
                continue;
            const auto a = static_cast<std::uint32_t>(fragment[f]);
            const auto b = static_cast<std::uint32_t>(fragment[static_cast<std::size_t>(g)]);
            if (a == b || (creases[f] >> k & 1) != 0) continue;
            const Vec3 edge = mesh.corner(f, static_cast<int>((k + 1) % 3)) - mesh.corner(f, static_cast<int>(k));
            merger.add(a, b, curvature_jump(field, mesh, f, k), norm(edge));
        }
    }
    merger.run(control);

    partition::Labels labels(mesh.face_count(), -1);
    for (const std::uint32_t f : field.face) {
        if (fragment[f] >= 0) {
            labels[f] = static_cast<std::int32_t>(merger.root(static_cast<std::uint32_t>(fragment[f])));
        }
    }
    partition::compact(labels);
    return labels;
}

}  // namespace quadseg::flow
