#include "partition/leaves.h"

#include "mesh/connected.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace quadseg::partition {
namespace {

// A leaf never crosses a block; 16K faces keep the cut borders below 1 % of the leaves. Where there is an order, for
// the sake of a result that does not depend on the mesh's place, blocks are as large as tasks may be.
constexpr std::size_t block_faces = 16384, ordered_block_faces = 65536;
constexpr double coplanar_normal = 1e-6;
constexpr double coplanar_offset = 2e-6;
constexpr std::int32_t unlabelled = -1;

/// Grows the leaves of one block of faces; labels are local to the block.
class BlockGrower {
  public:
    BlockGrower(const Passage& passage, const LeafOptions& options, Labels& labels, std::size_t begin, std::size_t end)
        : passage_(passage),
          mesh_(*passage.mesh),
          normals_(options.normals.empty() ? std::span<const Vec3>(mesh_.normals) : options.normals),
          options_(options),
          labels_(labels),
          begin_(begin),
          end_(end) {}

    std::size_t grow() {
        if (options_.smallest_coplanar > 0) grow_coplanar();
        grow_by_normal();
        grow_without_normal();
        return static_cast<std::size_t>(count_);
    }

  private:
    bool is_free(std::int32_t g) const noexcept {
        const auto u = static_cast<std::size_t>(g);
        return g >= 0 && u >= begin_ && u < end_ && labels_[u] == unlabelled;
    }
    bool has_normal(std::size_t f) const noexcept { return squared_norm(normals_[f]) > 0.25; }

    std::array<std::int32_t, 3> neighbors(std::size_t f) const noexcept {
        std::array<std::int32_t, 3> g = {passage_.across(f, 0), passage_.across(f, 1), passage_.across(f, 2)};
        if (!options_.order.empty()) {
            std::sort(g.begin(), g.end(), [&](std::int32_t a, std::int32_t b) {
                if (a < 0 || b < 0) return a < b;
                return comes_before(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
            });
        }
        return g;
    }
    bool comes_before(std::size_t a, std::size_t b) const noexcept {
        const double x = options_.order[a], y = options_.order[b];
        return x != y ? x < y : a < b;
    }
    std::vector<std::uint32_t> seeds() const {
        std::vector<std::uint32_t> faces(end_ - begin_);
        std::iota(faces.begin(), faces.end(), static_cast<std::uint32_t>(begin_));
        if (!options_.order.empty()) {
            std::sort(faces.begin(), faces.end(), [&](std::size_t a, std::size_t b) { return comes_before(a, b); });
        }
        return faces;
    }

    void grow_coplanar() {
        std::vector<std::uint8_t> tried(end_ - begin_, 0);
        for (std::size_t seed = begin_; seed < end_; ++seed) {
            if (labels_[seed] != unlabelled || !passage_.is_active(seed) || tried[seed - begin_] != 0) continue;
            const Vec3 n = mesh_.normals[seed];
            if (squared_norm(n) < 0.25) continue;
            const Vec3 anchor = mesh_.corner(seed, 0);
            queue_.assign(1, static_cast<std::uint32_t>(seed));
            labels_[seed] = count_;
            for (std::size_t head = 0; head < queue_.size(); ++head) {
                const std::size_t f = queue_[head];
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(f, k);
                    if (!is_free(g)) continue;
                    const auto u = static_cast<std::size_t>(g);
                    if (!(squared_norm(mesh_.normals[u] - n) <= coplanar_normal * coplanar_normal)) continue;
                    if (!(std::abs(dot(mesh_.centroid(u) - anchor, n)) <= coplanar_offset)) continue;
                    labels_[u] = count_;
                    queue_.push_back(static_cast<std::uint32_t>(u));
                }
            }
            if (queue_.size() >= options_.smallest_coplanar) {
                ++count_;
                continue;
            }
            for (const std::uint32_t f : queue_) {
                labels_[f] = unlabelled;
                tried[f - begin_] = 1;
            }
        }
    }

    void grow_by_normal() {
        const double angle = options_.angle * std::numbers::pi / 180;
        const double cosine = std::cos(angle), seed_cosine = std::cos(std::min(2 * angle, std::numbers::pi));
        for (const std::uint32_t seed : seeds()) {
            if (labels_[seed] != unlabelled || !passage_.is_active(seed) || !has_normal(seed)) continue;
            // The running mean is weighted by area, so that slivers with doubtful normals do not steer the leaf.
            Vec3 mean = normals_[seed] * mesh_.areas[seed];
            queue_.assign(1, seed);
            labels_[seed] = count_;
            for (std::size_t head = 0; head < queue_.size() && queue_.size() < options_.largest; ++head) {
                for (const std::int32_t g : neighbors(queue_[head])) {
                    if (!(queue_.size() < options_.largest)) break;
                    if (!is_free(g)) continue;
                    const auto u = static_cast<std::size_t>(g);
                    // A mean alone would wander off along a bend, one face after another.
                    if (has_normal(u) && !(dot(mean, normals_[u]) >= cosine * norm(mean) &&
                                           dot(normals_[seed], normals_[u]) >= seed_cosine)) {
                        continue;
                    }
                    mean += normals_[u] * mesh_.areas[u];
                    labels_[u] = count_;
                    queue_.push_back(static_cast<std::uint32_t>(u));
                }
            }
            ++count_;
        }
    }

    /// Faces without area that no leaf reached: they join a neighbour's leaf, or each other.
    void grow_without_normal() {
        for (std::size_t seed = begin_; seed < end_; ++seed) {
            if (labels_[seed] != unlabelled || !passage_.is_active(seed)) continue;
            queue_.assign(1, static_cast<std::uint32_t>(seed));
            labels_[seed] = count_;
            std::int32_t joined = unlabelled;
            for (std::size_t head = 0; head < queue_.size(); ++head) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(queue_[head], k);
                    if (g < 0) continue;
                    const auto u = static_cast<std::size_t>(g);
                    if (is_free(g)) {
                        labels_[u] = count_;
                        queue_.push_back(static_cast<std::uint32_t>(u));
                    } else if (joined < 0 && u >= begin_ && u < end_ && labels_[u] != count_) {
                        joined = labels_[u];
                    }
                }
            }
            if (joined < 0) {
                ++count_;
            } else {
                for (const std::uint32_t f : queue_) labels_[f] = joined;
            }
        }
    }

    const Passage& passage_;
    const mesh::WorkMesh& mesh_;
    std::span<const Vec3> normals_;
    const LeafOptions& options_;
    Labels& labels_;
    std::size_t begin_, end_;
    std::int32_t count_ = 0;
    std::vector<std::uint32_t> queue_;
};

}  // namespace

Leaves grow_leaves(const Passage& passage, const LeafOptions& options, const runtime::RunControl& control) {
    const std::size_t faces = passage.mesh->face_count();
    const std::size_t block = options.order.empty() ? block_faces : ordered_block_faces;
    Leaves leaves;
    leaves.labels.assign(faces, unlabelled);
    std::vector<std::size_t> offset((faces + block - 1) / block);
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        control.check();
        offset[begin / block] = BlockGrower(passage, options, leaves.labels, begin, end).grow();
    });
    leaves.count = runtime::exclusive_scan(offset);
    control.check();
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<std::int32_t>(offset[begin / block]);
        for (std::size_t f = begin; f < end; ++f) {
            if (leaves.labels[f] >= 0) leaves.labels[f] += first;
        }
    });
    return leaves;
}

std::size_t connected_parts(const Passage& passage, Labels& labels) {
    return mesh::connected_faces(
        *passage.mesh, [&](std::size_t f) { return labels[f] >= 0; },
        [&](std::size_t f, std::size_t k, std::size_t g) {
            return labels[f] == labels[g] && passage.across(f, k) >= 0 && passage.is_active(f);
        },
        [] {}, labels);
}

}  // namespace quadseg::partition
