#include "flow/facet_crumbs.h"

#include "mesh/connected.h"
#include "partition/face_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadseg::flow {

namespace {

constexpr double gentle_fold = 40 * std::numbers::pi / 180;
/// Mean facets of the region that it joins.
constexpr double most_facets = 4;
constexpr double least_ratio = 10;
constexpr double mostly = 0.5;
/// What a crumb kept apart from the region may join after it.
constexpr int rounds = 4;

class Crumbs {
  public:
    Crumbs(const mesh::WorkMesh& mesh, const exact::Facets& facets, const std::vector<Surface>& surfaces,
           const runtime::RunControl& control, partition::Labels& labels)
        : mesh_(mesh), facets_(facets), surfaces_(surfaces), control_(control), labels_(labels) {}

    bool absorb() {
        number_parts();
        measure();
        std::vector<Border> borders = gentle_borders();
        // Of a part the region that it shares most of its border with.
        std::vector<std::int32_t> target(area_.size(), -1);
        std::vector<double> longest(area_.size(), 0);
        for (const Border& b : borders) {
            const auto p = static_cast<std::size_t>(b.part), r = static_cast<std::size_t>(b.region);
            if (b.length <= longest[p] || b.length <= mostly * border_[p]) continue;
            if (least_ratio * area_[p] > area_[r] || area_[p] * facet_count_[r] > most_facets * area_[r]) continue;
            longest[p] = b.length;
            target[p] = b.region;
        }
        bool any = false;
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            const std::int32_t to = target[static_cast<std::size_t>(part_[f])];
            if (to < 0) continue;
            labels_[f] = to;
            any = true;
        }
        return any;
    }

  private:
    struct Border {
        std::int32_t part, region;
        double length;
    };

    /// Regions keep their number; connected faces without one follow.
    void number_parts() {
        std::vector<std::int32_t> loose;
        const std::size_t count = mesh::connected_faces(
            mesh_, [&](std::size_t f) { return labels_[f] < 0; },
            [&](std::size_t f, std::size_t k, std::size_t) {
                const std::int32_t g = mesh_.neighbors[f][k];
                return labels_[static_cast<std::size_t>(g)] < 0 && is_gentle(f, static_cast<std::size_t>(g));
            },
            [&] { control_.check(); }, loose);
        const auto first = static_cast<std::int32_t>(surfaces_.size());
        part_ = labels_;
        for (std::size_t f = 0; f < part_.size(); ++f) {
            if (part_[f] < 0) part_[f] = first + loose[f];
        }
        area_.assign(surfaces_.size() + count, 0);
        facet_count_.assign(area_.size(), 0);
        border_.assign(area_.size(), 0);
    }

    void measure() {
        std::size_t polls = 0;
        for (std::size_t f = 0; f < part_.size(); ++f) {
            control_.check_often(polls);
            const auto p = static_cast<std::size_t>(part_[f]);
            area_[p] += mesh_.areas[f];
            const auto own = static_cast<std::size_t>(facets_.of_face[f]);
            if (facets_.face[facets_.begin[own]] == f) facet_count_[p] += 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                if (g < 0 || part_[static_cast<std::size_t>(g)] != part_[f])
                    border_[p] += partition::edge_length(mesh_, f, k);
            }
        }
    }

    bool is_gentle(std::size_t f, std::size_t g) const {
        return angle_between(mesh_.normals[f], mesh_.normals[g]) < gentle_fold;
    }

    std::vector<Border> gentle_borders() const {
        std::vector<Border> edges;
        std::size_t polls = 0;
        for (std::size_t f = 0; f < part_.size(); ++f) {
            control_.check_often(polls);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                if (g < 0) continue;
                const std::int32_t region = labels_[static_cast<std::size_t>(g)];
                if (region < 0 || region == part_[f] ||
                    surfaces_[static_cast<std::size_t>(region)].type == SurfaceType::plane)
                    continue;
                if (is_gentle(f, static_cast<std::size_t>(g)))
                    edges.push_back({part_[f], region, partition::edge_length(mesh_, f, k)});
            }
        }
        std::stable_sort(edges.begin(), edges.end(), [](const Border& a, const Border& b) {
            return a.part != b.part ? a.part < b.part : a.region < b.region;
        });
        std::vector<Border> borders;
        for (const Border& edge : edges) {
            if (borders.empty() || borders.back().part != edge.part || borders.back().region != edge.region) {
                borders.push_back(edge);
            } else {
                borders.back().length += edge.length;
            }
        }
        return borders;
    }

    const mesh::WorkMesh& mesh_;
    const exact::Facets& facets_;
    const std::vector<Surface>& surfaces_;
    const runtime::RunControl& control_;
    partition::Labels& labels_;
    std::vector<std::int32_t> part_;
    std::vector<double> area_, border_, facet_count_;  ///< of the parts
};

}  // namespace

void absorb_facet_crumbs(const mesh::WorkMesh& mesh, const exact::Facets& facets, const std::vector<Surface>& surfaces,
                         const runtime::RunControl& control, partition::Labels& labels) {
    for (int round = 0; round < rounds; ++round) {
        if (!Crumbs(mesh, facets, surfaces, control, labels).absorb()) return;
    }
}

}  // namespace quadseg::flow
