#include "flow/faceted.h"

#include "mesh/connected.h"
#include "mesh/group_sums.h"
#include "partition/face_choice.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace quadseg::flow {

namespace {

constexpr double degree = std::numbers::pi / 180;
/// Folds are compared with that which this share of a part's edges stays below: the step of its facets.
constexpr double step_quantile = 0.97;
constexpr double least_step = 0.5 * degree, most_step = 40 * degree;
/// Within facets the mesh is flat to the rounding of its coordinates, between them it folds, and there is little in
/// between.
constexpr double flat_share_of_step = 0.02, most_flat_fold = 0.1 * degree, bent_share_of_step = 0.2;
constexpr double least_flat = 0.4, most_between = 0.25;
constexpr std::size_t least_edges = 30;
/// A region gives way to the parts beside it when they are larger than it by so much …
constexpr double least_ratio = 4;
/// … and it passes smoothly into them along more than this share of its border …
constexpr double mostly = 0.5;
/// … and is not so many times wider than the facets across that border: a plane between fillets is no facet.
constexpr double most_wider = 4;
/// Of two areas: then the border between them is no argument against the smaller one's being a facet.
constexpr double tangent_ratio = 10;
/// Faces that fold by less lie on one facet.
constexpr double flat_fold = 0.15 * degree;

double fold(const mesh::WorkMesh& mesh, std::size_t f, std::size_t g) noexcept {
    return angle_between(mesh.normals[f], mesh.normals[g]);
}

bool is_crease(const mesh::FeatureEdges& creases, std::size_t f, std::size_t k) noexcept {
    return (creases[f] >> k & 1) != 0;
}

bool has_two_kinds_of_folds(std::vector<float>& folds) {
    if (folds.size() < least_edges) return false;
    const auto at = folds.begin() + static_cast<std::ptrdiff_t>(step_quantile * static_cast<double>(folds.size()));
    std::nth_element(folds.begin(), at, folds.end());
    const double step = *at;
    if (step < least_step || step > most_step) return false;
    const auto share_below = [&](double limit) {
        return static_cast<double>(std::count_if(folds.begin(), folds.end(), [&](float x) { return x < limit; })) /
               static_cast<double>(folds.size());
    };
    const double flat = share_below(std::min(flat_share_of_step * step, most_flat_fold));
    return flat >= least_flat && share_below(bent_share_of_step * step) - flat <= most_between;
}

class FacetedParts {
  public:
    FacetedParts(const FlowInput& input, const mesh::FeatureEdges& creases, const std::vector<Surface>& surfaces,
                 partition::Labels& explained)
        : mesh_(input.mesh),
          control_(input.control),
          creases_(creases),
          surfaces_(surfaces),
          explained_(explained),
          faceted_(explained.size(), 0) {}

    std::vector<std::uint8_t> run() {
        measure_facets();
        std::vector<std::uint8_t> strips = find_strips();
        find_parts(strips);
        if (keep_small(strips)) find_parts(strips);
        flag_parts();
        // What was between a region and the part may have been a facet itself.
        while (release_regions()) {
        }
        return std::move(faceted_);
    }

  private:
    bool is_plane(std::int32_t region) const {
        return surfaces_[static_cast<std::size_t>(region)].type == SurfaceType::plane;
    }

    /// visit(face, edge, face across or −1) for every edge at which a group of faces ends, in the order of the faces.
    /// All threads look for those that have such edges: they are few.
    template <class Visit>
    void for_borders(const std::vector<std::int32_t>& group, const Visit& visit) const {
        constexpr std::size_t block = 16384;
        const auto ends = [&](std::size_t f, std::int32_t g) {
            return g < 0 || group[static_cast<std::size_t>(g)] != group[f];
        };
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& faces) {
            control_.check();
            for (std::size_t f = begin; f < end; ++f) {
                const auto& neighbors = mesh_.neighbors[f];
                if (group[f] >= 0 && (ends(f, neighbors[0]) || ends(f, neighbors[1]) || ends(f, neighbors[2])))
                    faces.push_back(static_cast<std::uint32_t>(f));
            }
        };
        std::size_t polls = 0;
        for (const std::uint32_t f : runtime::collect_blocks<std::uint32_t>(group.size(), block, find)) {
            control_.check_often(polls);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                if (ends(f, g)) visit(f, k, g);
            }
        }
    }

    /// Twice the area over the perimeter: the width of a long strip, half that of a square.
    void measure_facets() {
        const std::size_t facets = mesh::connected_faces(
            mesh_, [](std::size_t) { return true; },
            [&](std::size_t f, std::size_t k, std::size_t g) {
                return explained_[f] == explained_[g] && !is_crease(creases_, f, k) &&
                       (explained_[f] >= 0 || fold(mesh_, f, g) < flat_fold);
            },
            [&] { control_.check(); }, facet_);
        std::vector<double> area(facets, 0), perimeter(facets, 0);
        mesh::add_by_group(facet_, mesh_.areas, area);
        for_borders(facet_, [&](std::size_t f, std::size_t k, std::int32_t) {
            perimeter[static_cast<std::size_t>(facet_[f])] += partition::edge_length(mesh_, f, k);
        });
        width_.resize(facets);
        for (std::size_t i = 0; i < facets; ++i) width_[i] = perimeter[i] > 0 ? 2 * area[i] / perimeter[i] : 0;
    }

    double width_at(std::size_t f) const { return width_[static_cast<std::size_t>(facet_[f])]; }

    /// A flag a region: planes that pass gently into planes and unexplained faces along most of their border.
    std::vector<std::uint8_t> find_strips() const {
        std::vector<double> length(surfaces_.size(), 0), gentle(surfaces_.size(), 0), wider(surfaces_.size(), 0);
        for_borders(explained_, [&](std::size_t f, std::size_t k, std::int32_t g) {
            const auto r = static_cast<std::size_t>(explained_[f]);
            const double edge = partition::edge_length(mesh_, f, k);
            length[r] += edge;
            if (g < 0 || is_crease(creases_, f, k)) return;
            const std::int32_t other = explained_[static_cast<std::size_t>(g)];
            if (other >= 0 && !is_plane(other)) return;
            gentle[r] += edge;
            wider[r] += edge * (width_at(f) - most_wider * width_at(static_cast<std::size_t>(g)));
        });
        std::vector<std::uint8_t> strips(surfaces_.size(), 0);
        for (std::size_t r = 0; r < strips.size(); ++r) {
            const bool plane = surfaces_[r].type == SurfaceType::plane;
            strips[r] = plane && gentle[r] > mostly * length[r] && wider[r] <= 0 ? 1 : 0;
        }
        return strips;
    }

    bool is_loose(std::size_t f, const std::vector<std::uint8_t>& strips) const {
        return explained_[f] < 0 || strips[static_cast<std::size_t>(explained_[f])] != 0;
    }

    void find_parts(const std::vector<std::uint8_t>& strips) {
        const std::size_t parts = mesh::connected_faces(
            mesh_, [&](std::size_t f) { return is_loose(f, strips); },
            [&](std::size_t f, std::size_t k, std::size_t) { return !is_crease(creases_, f, k); },
            [&] { control_.check(); }, part_);
        part_area_.assign(parts, 0);
        mesh::add_by_group(part_, mesh_.areas, part_area_);
    }

    /// Strips that are no small share of their part are planes that someone meant. True: there were some.
    bool keep_small(std::vector<std::uint8_t>& strips) const {
        std::vector<double> area(strips.size(), 0), around(strips.size(), 0);
        for (std::size_t f = 0; f < part_.size(); ++f) {
            if (part_[f] < 0 || explained_[f] < 0) continue;
            const auto r = static_cast<std::size_t>(explained_[f]);
            area[r] += mesh_.areas[f];
            around[r] = part_area_[static_cast<std::size_t>(part_[f])];
        }
        bool any = false;
        for (std::size_t r = 0; r < strips.size(); ++r) {
            if (strips[r] == 0 || least_ratio * area[r] < around[r]) continue;
            strips[r] = 0;
            any = true;
        }
        return any;
    }

    /// Faces of the parts whose folds are of two kinds.
    void flag_parts() {
        std::vector<std::vector<float>> folds(part_area_.size());
        std::size_t polls = 0;
        for (std::size_t f = 0; f < part_.size(); ++f) {
            control_.check_often(polls);
            if (part_[f] < 0 || !(mesh_.areas[f] > 0)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                if (g <= static_cast<std::int32_t>(f) || part_[static_cast<std::size_t>(g)] != part_[f]) continue;
                if (!is_crease(creases_, f, k))
                    folds[static_cast<std::size_t>(part_[f])].push_back(
                        static_cast<float>(fold(mesh_, f, static_cast<std::size_t>(g))));
            }
        }
        std::vector<std::uint8_t> is_faceted(folds.size());
        for (std::size_t p = 0; p < folds.size(); ++p) is_faceted[p] = has_two_kinds_of_folds(folds[p]) ? 1 : 0;
        for (std::size_t f = 0; f < part_.size(); ++f) {
            if (part_[f] < 0 || is_faceted[static_cast<std::size_t>(part_[f])] == 0) {
                part_[f] = -1;
            } else {
                faceted_[f] = 1;
                explained_[f] = -1;
            }
        }
    }

    struct Border {
        double area = 0, length = 0;
        double smooth = 0;        ///< of the length, towards faceted parts
        double wider = 0;         ///< Σ length · (own width − most_wider · that across) over it
        double largest_part = 0;  ///< area of the largest of them
        std::int32_t part = -1;
    };

    bool release_regions() {
        std::vector<Border> borders(surfaces_.size());
        std::vector<double> areas(surfaces_.size(), 0);
        mesh::add_by_group(explained_, mesh_.areas, areas);
        for (std::size_t r = 0; r < borders.size(); ++r) borders[r].area = areas[r];
        for_borders(explained_, [&](std::size_t f, std::size_t k, std::int32_t g) {
            Border& border = borders[static_cast<std::size_t>(explained_[f])];
            const double edge = partition::edge_length(mesh_, f, k);
            const bool smooth = g >= 0 && !is_crease(creases_, f, k);
            if (smooth && explained_[static_cast<std::size_t>(g)] >= 0) {
                // The last row of facets passes smoothly into the face that the surface is tangent to.
                const Border& other = borders[static_cast<std::size_t>(explained_[static_cast<std::size_t>(g)])];
                if (other.area > tangent_ratio * border.area) return;
            }
            border.length += edge;
            if (!smooth || faceted_[static_cast<std::size_t>(g)] == 0) return;
            border.smooth += edge;
            border.wider += edge * (width_at(f) - most_wider * width_at(static_cast<std::size_t>(g)));
            const std::int32_t part = part_[static_cast<std::size_t>(g)];
            const double area = part_area_[static_cast<std::size_t>(part)];
            if (border.part >= 0 && area <= border.largest_part) return;
            border.largest_part = area;
            border.part = part;
        });
        std::vector<std::uint8_t> released(borders.size(), 0);
        bool any = false;
        for (std::size_t r = 0; r < borders.size(); ++r) {
            const Border& b = borders[r];
            released[r] =
                b.part >= 0 && b.smooth > mostly * b.length && b.wider <= 0 && least_ratio * b.area < b.largest_part
                    ? 1
                    : 0;
            any = any || released[r] != 0;
        }
        if (!any) return false;
        for (std::size_t f = 0; f < explained_.size(); ++f) {
            if (explained_[f] < 0 || released[static_cast<std::size_t>(explained_[f])] == 0) continue;
            part_[f] = borders[static_cast<std::size_t>(explained_[f])].part;
            part_area_[static_cast<std::size_t>(part_[f])] += mesh_.areas[f];
            faceted_[f] = 1;
            explained_[f] = -1;
        }
        return true;
    }

    const mesh::WorkMesh& mesh_;
    const runtime::RunControl& control_;
    const mesh::FeatureEdges& creases_;
    const std::vector<Surface>& surfaces_;
    partition::Labels& explained_;
    std::vector<std::uint8_t> faceted_;
    std::vector<std::int32_t> facet_;  ///< of every face: faces of one region, or coplanar ones
    std::vector<double> width_;        ///< of the facets
    std::vector<std::int32_t> part_;   ///< of the faces that may be faceted, in the end of those that are
    std::vector<double> part_area_;
};

}  // namespace

std::vector<std::uint8_t> find_faceted(const FlowInput& input, const mesh::FeatureEdges& creases,
                                       const std::vector<Surface>& surfaces, partition::Labels& explained) {
    return FacetedParts(input, creases, surfaces, explained).run();
}

}  // namespace quadseg::flow
