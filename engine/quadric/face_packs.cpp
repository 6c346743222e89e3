#include "quadric/face_packs.h"

#include "quadric/lane_moments.h"
#include "quadric/normal_equations.h"
#include "quadric/sheets.h"
#include "quadric/triangle_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace quadseg::quadric {
namespace {

constexpr double floor_share = 0.05;        // of the median |∇f⁰(c_t)| (MATH.md §3)
constexpr std::size_t median_sample = 512;  // faces, evenly spaced, that the median is taken of

void centroid(const FacePart& f, Part* x) noexcept {
    for (std::size_t k = 0; k < 3; ++k) x[k] = (f.corners[k] + f.corners[k + 3] + f.corners[k + 6]) * (1.0 / 3);
}

void gradient_length(const Coefficients& c, const Part* x, Part& length) noexcept {
    const PartGradient g(c, x[0], x[1], x[2]);
    square_root(g.x * g.x + g.y * g.y + g.z * g.z, length);
}

/// Of triangles with centroids x and moments t.
void add_weighted(const Candidate& candidate, std::size_t part, const FacePart& f, const Part* x, const Part* t,
                  LaneMoments& sum) noexcept {
    Part length;
    gradient_length(candidate.c, x, length);
    maximum(length, Part{} + candidate.gradient_floor, length);
    const Part w1 = 1.0 / length, w2 = w1 * w1;
    sum.add(part, t, f.normal, w2, w1);
}

bool takes_part(double area) noexcept {
    return area > 0 && area <= std::numeric_limits<double>::max();
}

}  // namespace

FacePacks::FacePacks(const TriangleSoup& region, bool with_moments, const std::function<void()>* poll)
    : poll_(poll), faces_(region.size()) {
    // Centroid, and a radius good enough to scale with, about a point of the region: no cancellation far from 0.
    Vec3 reference, first;
    double second = 0;
    for (std::size_t t = 0; t < faces_; ++t) {
        if (t % (polled_packs * lanes) == 0) poll_packs();
        const double a = region.areas[t];
        if (!takes_part(a)) continue;
        const Vec3* const corner = &region.corners[3 * t];
        if (area_ == 0) reference = corner[0];
        const Vec3 u = corner[0] - reference, v = corner[1] - reference, w = corner[2] - reference;
        area_ += a;
        first += (u + v + w) * a;
        second += a * (squared_norm(u) + squared_norm(v) + squared_norm(w));
    }
    if (!(area_ > 0)) return;
    const Vec3 mean = first / (3 * area_);
    const double radius = std::sqrt(second / (3 * area_) - squared_norm(mean));
    if (!(radius > 0) || !std::isfinite(radius) || !std::isfinite(area_)) {
        area_ = 0;
        return;
    }
    centre_ = reference + mean;
    scale_ = 1 / radius;

    pack_count_ = (faces_ + lanes - 1) / lanes;
    packs_ = std::make_unique_for_overwrite<FacePack[]>(pack_count_);
    LaneMoments sum;
    Pack normal_area{}, area{};
    const double area_scale = scale_ * scale_;
    for (std::size_t p = 0; p < pack_count_; ++p) {
        if (p % polled_packs == 0) poll_packs();
        FacePack f{};
        const std::size_t begin = p * lanes, count = std::min(lanes, faces_ - begin);
        for (std::size_t l = 0; l < count; ++l) {
            const std::size_t t = begin + l;
            if (!takes_part(region.areas[t])) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 u = (region.corners[3 * t + k] - centre_) * scale_;
                f.corners[3 * k][l] = u.x;
                f.corners[3 * k + 1][l] = u.y;
                f.corners[3 * k + 2][l] = u.z;
            }
            f.normal[0][l] = region.normals[t].x;
            f.normal[1][l] = region.normals[t].y;
            f.normal[2][l] = region.normals[t].z;
            f.area[l] = region.areas[t] * area_scale;
        }
        packs_[p] = f;
        if (!with_moments) {
            area += f.area;
            continue;
        }
        for (std::size_t part = 0; part < parts; ++part) {
            const FacePart some(f, part);
            Part t[35];
            triangle_moments(some.corners, some.area, t);
            sum.add(part, t, some.normal);
        }
        normal_area += f.area * (f.normal[0] * f.normal[0] + f.normal[1] * f.normal[1] + f.normal[2] * f.normal[2]);
    }
    if (with_moments) {
        sum.sum(moments_);
    } else {
        moments_.area[0] = horizontal_sum(area);
    }
    moments_.total_area = moments_.area[0];
    moments_.normal_area = horizontal_sum(normal_area);
}

Candidate FacePacks::prepare(const Coefficients& c) {
    Candidate result;
    result.c = c;
    const double orientation = dot(c, normal_vector(moments_));
    lengths_.resize(pack_count_ * lanes);
    Pack mean_pack{};
    for (std::size_t p = 0; p < pack_count_; ++p) {
        if (p % polled_packs == 0) poll_packs();
        Pack length;
        for (std::size_t part = 0; part < parts; ++part) {
            Part x[3];
            centroid(FacePart(packs_[p], part), x);
            gradient_length(c, x, part_of(length, part));
        }
        mean_pack += packs_[p].area * length;
        std::memcpy(&lengths_[p * lanes], &length, sizeof length);
    }
    const double mean = horizontal_sum(mean_pack) / moments_.area[0];
    if (!(mean > 0) || !(mean <= std::numeric_limits<double>::max())) return result;
    const std::size_t stride = (faces_ + median_sample - 1) / median_sample;
    sample_.clear();
    for (std::size_t t = 0; t < faces_; t += stride) sample_.push_back(lengths_[t]);
    const auto middle = sample_.begin() + static_cast<std::ptrdiff_t>(sample_.size() / 2);
    std::nth_element(sample_.begin(), middle, sample_.end());
    const double scale = 1 / mean;
    for (double& v : result.c) v *= orientation < 0 ? -scale : scale;
    result.gradient_floor = std::max(1e-6, floor_share * *middle * scale);
    result.usable = std::isfinite(orientation);
    return result;
}

template <std::size_t count>
void FacePacks::reweigh_all(const std::array<const Candidate*, count>& candidates,
                            const std::array<Moments*, count>& out) const {
    std::array<LaneMoments, count> sums;
    for (std::size_t first = 0; first < pack_count_; first += polled_packs) {
        poll_packs();
        for (const FacePack& f : packs(first)) {
            for (std::size_t part = 0; part < parts; ++part) {
                const FacePart some(f, part);
                Part x[3], t[35];
                centroid(some, x);
                triangle_moments(some.corners, some.area, t);
                for (std::size_t i = 0; i < count; ++i) add_weighted(*candidates[i], part, some, x, t, sums[i]);
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        *out[i] = moments_;
        sums[i].sum(*out[i]);
    }
}

void FacePacks::reweigh(const Candidate& first, const Candidate& second, Moments& out_first,
                        Moments& out_second) const {
    reweigh_all<2>({&first, &second}, {&out_first, &out_second});
}

void FacePacks::reweigh(const Candidate& candidate, Moments& out) const {
    reweigh_all<1>({&candidate}, {&out});
}

void FacePacks::evaluate(Candidate& candidate) const {
    const Coefficients& c = candidate.c;
    const Part floor = Part{} + candidate.gradient_floor;
    Pack distance{}, normal{}, against{};
    for (std::size_t first = 0; first < pack_count_; first += polled_packs) {
        poll_packs();
        for (std::size_t part = 0; part < parts; ++part) {
            Part &d = part_of(distance, part), &n = part_of(normal, part), &a = part_of(against, part);
            for (const FacePack& pack : packs(first)) {
                const FacePart f(pack, part);
                PartEnergy energy;
                part_energy(c, f, floor, energy);
                d += energy.distance;
                n += energy.normal;
                a += f.area - energy.along;
            }
        }
    }
    candidate.distance = std::max(0.0, horizontal_sum(distance) * (1.0 / 180));
    candidate.normal = std::max(0.0, horizontal_sum(normal) * (1.0 / 12));
    candidate.against = horizontal_sum(against);
    if (!std::isfinite(candidate.distance + candidate.normal)) candidate.usable = false;
}

double FacePacks::share_on_other_sheet(const Coefficients& c) const {
    const Sheets sheets(c);
    if (sheets.kind() == Sheets::Kind::connected) return 0;
    if (sheets.kind() == Sheets::Kind::imaginary) return 1;
    double second = 0, whole = 0;
    for (std::size_t part = 0; part < pack_count_; part += polled_packs) {
        poll_packs();
        for (const FacePack& f : packs(part)) {
            const Pack* const v = &f.corners[0];
            for (std::size_t l = 0; l < lanes; ++l) {
                whole += f.area[l];
                const Vec3 sum =
                    Vec3{v[0][l], v[1][l], v[2][l]} + Vec3{v[3][l], v[4][l], v[5][l]} + Vec3{v[6][l], v[7][l], v[8][l]};
                if (sheets.foot_on_second_side(c, sum * (1.0 / 3))) second += f.area[l];
            }
        }
    }
    return std::min(second, whole - second) / whole;
}

}  // namespace quadseg::quadric
