#include "quadric/moment_buffers.h"

#include "quadric/lane_moments.h"
#include "quadric/moment_accumulator.h"
#include "quadric/triangle_moments.h"

#include <algorithm>
#include <utility>

namespace quadseg::quadric {
namespace {

struct LoadedFaces {
    Pack corners[9]{};
    Pack normal[3]{};
    Pack area{};

    LoadedFaces(const TriangleSoup& soup, std::size_t begin, const Vec3& origin) noexcept {
        const std::size_t count = begin < soup.size() ? std::min(lanes, soup.size() - begin) : 0;
        for (std::size_t l = 0; l < count; ++l) {
            const std::size_t t = begin + l;
            if (!(soup.areas[t] > 0)) continue;  // corners of such faces may be anything
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 u = soup.corners[3 * t + k] - origin;
                corners[3 * k][l] = u.x;
                corners[3 * k + 1][l] = u.y;
                corners[3 * k + 2][l] = u.z;
            }
            normal[0][l] = soup.normals[t].x;
            normal[1][l] = soup.normals[t].y;
            normal[2][l] = soup.normals[t].z;
            area[l] = soup.areas[t];
        }
    }
};

}  // namespace

Moments soup_moments(const TriangleSoup& soup, const Vec3& origin) noexcept {
    MomentAccumulator sum;
    for (std::size_t t = 0; t < soup.size(); ++t) {
        sum.add(soup.corners[3 * t] - origin, soup.corners[3 * t + 1] - origin, soup.corners[3 * t + 2] - origin,
                soup.normals[t], soup.areas[t]);
    }
    return sum.moments();
}

Vec3 soup_centroid(const TriangleSoup& soup) noexcept {
    double area = 0;
    Vec3 reference, first;
    for (std::size_t t = 0; t < soup.size(); ++t) {
        const double a = soup.areas[t];
        if (!(a > 0)) continue;
        if (area == 0) reference = soup.corners[3 * t];
        area += a;
        first += ((soup.corners[3 * t] - reference) + (soup.corners[3 * t + 1] - reference) +
                  (soup.corners[3 * t + 2] - reference)) *
                 a;
    }
    if (area > 0) return reference + first / (3 * area);
    return soup.corners.empty() ? Vec3{} : soup.corners[0];
}

MomentBuffers::MomentBuffers(std::vector<std::uint32_t> block_begin) : begin_(std::move(block_begin)) {
    if (begin_.empty()) begin_.push_back(0);
    blocks_.resize(begin_.size() - 1);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        blocks_[b].first_group = group_count_;
        blocks_[b].groups = (block_size(b) + lanes - 1) / lanes;
        group_count_ += blocks_[b].groups;
    }
    groups_ = std::make_unique_for_overwrite<Group[]>(group_count_);
}

void MomentBuffers::fill(std::size_t b, const TriangleSoup& faces) {
    Block& block = blocks_[b];
    block.origin = soup_centroid(faces);
    LaneMoments sum;
    LaneAreas areas;
    for (std::size_t p = 0; p < block.groups; ++p) {
        const LoadedFaces f(faces, p * lanes, block.origin);
        Group& group = groups_[block.first_group + p];
        triangle_moments(&f.corners[0], f.area, &group.moments[0]);
        for (std::size_t axis = 0; axis < 3; ++axis) group.normal[axis] = f.normal[axis];
        sum.add(&group.moments[0], f.normal);
        areas.add(f.area, f.normal);
    }
    sum.sum(block.sum);
    areas.sum(block.sum);
}

std::size_t MomentBuffers::bytes() const noexcept {
    return group_count_ * sizeof(Group) + blocks_.size() * sizeof(Block) + begin_.size() * sizeof(std::uint32_t);
}

Moments MomentBuffers::weighted_moments(std::size_t b, std::size_t first, std::span<const double> w2,
                                        std::span<const double> w1) const noexcept {
    const Block& block = blocks_[b];
    const std::size_t end = first + w2.size();
    LaneMoments sum;
    LaneAreas areas;
    for (std::size_t p = first / lanes; p * lanes < end; ++p) {
        Pack weight2{}, weight1{}, present{};
        for (std::size_t l = 0; l < lanes; ++l) {
            const std::size_t slot = p * lanes + l;
            if (slot < first || slot >= end || w2[slot - first] == 0) continue;
            weight2[l] = w2[slot - first];
            weight1[l] = w1[slot - first];
            present[l] = 1;
        }
        const Group& group = groups_[block.first_group + p];
        sum.add(&group.moments[0], &group.normal[0], weight2, weight1);
        areas.add(present * group.moments[0], &group.normal[0]);
    }
    Moments result;
    sum.sum(result);
    areas.sum(result);
    return result;
}

void MomentBuffers::accumulate(Moments& region, const Vec3& region_origin, std::size_t b, std::size_t first,
                               std::span<const double> w2, std::span<const double> w1) const noexcept {
    region += shifted(weighted_moments(b, first, w2, w1), region_origin - blocks_[b].origin);
}

void MomentBuffers::accumulate(Moments& region, const Vec3& region_origin, std::size_t b) const noexcept {
    region += shifted(blocks_[b].sum, region_origin - blocks_[b].origin);
}

}  // namespace quadseg::quadric
