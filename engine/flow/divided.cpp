#include "flow/divided.h"

#include "exact/exact.h"
#include "exact/facets.h"
#include "exact/tolerances.h"
#include "flow/facet_crumbs.h"
#include "flow/simplified_mesh.h"
#include "runtime/parallel.h"
#include "simplify/undivide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace quadseg::flow {

namespace {

constexpr double degree = std::numbers::pi / 180;
/// Facets of one surface fold by more than rounding and by less than a crease of the exact stage.
constexpr double least_fold = 0.1 * degree, most_fold = 40 * degree;
/// Facets are flat to a tolerance: neighbours that hardly leave their plane may be one with them.
constexpr double clear = 20;
/// A row of facets, each with a divided edge on either side: fewer show no surface.
constexpr std::size_t least_facets = 4;
/// Taking out less than this share of a component's faces is not worth a second search.
constexpr double least_removed = 0.05;
/// A component is taken over when so many times the area lies on curved surfaces, and hardly more on none: only facets
/// of free-form faces, each of which was a plane.
constexpr double least_gain = 1.1, most_price = 0.5;

class DividedSearch {
  public:
    DividedSearch(const FlowInput& input, const exact::ExactSurfaces& exact)
        : mesh_(input.mesh),
          control_(input.control),
          labels_(exact.labels),
          surfaces_(exact.surfaces),
          tolerances_(exact.tolerances),
          facets_(exact.facets) {}

    std::optional<DividedSurfaces> run() {
        if (!has_gentle_rows()) return std::nullopt;
        control_.check();
        const std::vector<std::uint8_t> wanted = components_with_divided_rows();
        if (wanted.empty()) return std::nullopt;
        const std::optional<Plain> plain = undivide(wanted);
        return plain ? adopt(*plain) : std::nullopt;
    }

  private:
    bool is_loose(std::size_t f) const {
        return labels_[f] < 0 || surfaces_[static_cast<std::size_t>(labels_[f])].type == SurfaceType::plane;
    }
    bool folds_gently(std::size_t f, std::size_t g) const {
        const double fold = angle_between(mesh_.normals[f], mesh_.normals[g]);
        return fold > least_fold && fold < most_fold;
    }
    /// The facets beside the edge do not only differ by the rounding of their vertices.
    bool folds_clearly(std::size_t f, std::size_t g) const {
        const Vec3& normal = facets_.facet[static_cast<std::size_t>(facets_.of_face[f])].normal;
        double farthest = 0;
        for (int k = 0; k < 3; ++k)
            farthest = std::max(farthest, std::abs(dot(normal, mesh_.corner(g, k) - mesh_.corner(f, 0))));
        return farthest > clear * tolerances_.facet;
    }

    /// Most meshes are done with here.
    bool has_gentle_rows() const {
        std::size_t edges = 0, polls = 0;
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            control_.check_often(polls);
            if (!is_loose(f)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                if (g < static_cast<std::int32_t>(f)) continue;
                const auto other = static_cast<std::size_t>(g);
                if (labels_[f] >= 0 && labels_[other] == labels_[f]) continue;
                if (is_loose(other) && folds_gently(f, other) && ++edges >= 2 * least_facets) return true;
            }
        }
        return false;
    }

    bool is_triangle(std::int32_t facet) const { return facets_.size(static_cast<std::size_t>(facet)) == 1; }

    /// A flag a component in which loose facets in a row have vertices that are no corners of theirs; empty: none.
    std::vector<std::uint8_t> components_with_divided_rows() const {
        constexpr std::int32_t none = -1, many = -2;
        struct Ends {
            std::int32_t first = none, second = none;
            void add(std::int32_t x) {
                if (x == first || x == second || first == many) return;
                if (first == none)
                    first = x;
                else if (second == none)
                    second = x;
                else
                    first = many;
            }
        };
        // Facets with two different ones beside them, all of more than a triangle …
        std::vector<Ends> beside(facets_.count());
        constexpr std::size_t block = 16384;
        using Pair = std::pair<std::int32_t, std::int32_t>;
        const auto find_pairs = [&](std::size_t begin, std::size_t end, std::vector<Pair>& pairs) {
            control_.check();
            for (std::size_t f = begin; f < end; ++f) {
                const std::int32_t own = facets_.of_face[f];
                if (!is_loose(f) || is_triangle(own)) continue;
                for (const std::int32_t g : mesh_.neighbors[f]) {
                    if (g == mesh::no_face || !is_loose(static_cast<std::size_t>(g))) continue;
                    const std::int32_t other = facets_.of_face[static_cast<std::size_t>(g)];
                    if (own == other || is_triangle(other) || !folds_gently(f, static_cast<std::size_t>(g)) ||
                        !folds_clearly(f, static_cast<std::size_t>(g)))
                        continue;
                    pairs.emplace_back(own, other);
                }
            }
        };
        for (const auto& [own, other] : runtime::collect_blocks<Pair>(labels_.size(), block, find_pairs))
            beside[static_cast<std::size_t>(own)].add(other);
        const auto in_row = [&](const Ends& ends) { return ends.first == many || ends.second != none; };
        if (std::none_of(beside.begin(), beside.end(), in_row)) return {};
        // … are a row where they have vertices that are no corners of theirs.
        std::vector<Ends> at_vertex(mesh_.vertex_count());
        std::size_t polls = 0;
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            control_.check_often(polls);
            for (std::size_t k = 0; k < 3; ++k) {
                Ends& ends = at_vertex[mesh_.faces[f][k]];
                ends.add(facets_.of_face[f]);
                if (mesh_.neighbors[f][k] != mesh::no_face) continue;
                ends.first = at_vertex[mesh_.faces[f][(k + 1) % 3]].first = many;
            }
        }
        const auto is_divided = [&](std::size_t i) {
            for (std::size_t j = facets_.begin[i]; j < facets_.begin[i + 1]; ++j) {
                const std::uint32_t f = facets_.face[j];
                if (!is_loose(f)) continue;
                for (const std::uint32_t v : mesh_.faces[f])
                    if (at_vertex[v].first != many) return true;
            }
            return false;
        };
        std::vector<std::size_t> rows(mesh_.component_count, 0);
        for (std::size_t i = 0; i < facets_.count(); ++i) {
            if (!in_row(beside[i]) || !is_divided(i)) continue;
            ++rows[static_cast<std::size_t>(mesh_.components[facets_.face[facets_.begin[i]]])];
        }
        std::vector<std::uint8_t> wanted(rows.size());
        std::transform(rows.begin(), rows.end(), wanted.begin(),
                       [](std::size_t count) { return count >= least_facets ? 1 : 0; });
        if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) wanted.clear();
        return wanted;
    }

    /// The tessellation without divisions.
    struct Plain {
        std::vector<std::uint8_t> components;  ///< flags of those that it is made of
        exact::ExactSurfaces found;
        std::vector<std::uint32_t> face;  ///< of the work mesh: one of the same facet, for each label
        std::vector<double> area;         ///< of the faces that have the labels
        std::vector<std::uint8_t> kept;   ///< a work vertex each
    };

    /// None: hardly anything to take out.
    std::optional<Plain> undivide(const std::vector<std::uint8_t>& wanted) const {
        std::vector<std::array<std::uint32_t, 3>> faces;
        std::vector<std::uint32_t> source;
        std::vector<std::int32_t> facet;
        std::vector<std::size_t> count(wanted.size(), 0), count_left(wanted.size(), 0);
        const auto component = [&](std::uint32_t f) { return static_cast<std::size_t>(mesh_.components[f]); };
        for (std::uint32_t f = 0; f < labels_.size(); ++f) {
            if (wanted[component(f)] == 0) continue;
            ++count[component(f)];
            faces.push_back(mesh_.faces[f]);
            source.push_back(f);
            facet.push_back(facets_.of_face[f]);
        }
        simplify::Undivided plain =
            simplify::undivide(mesh_.positions, faces, facet, {tolerances_.facet, [&] { control_.check(); }});
        for (const std::uint32_t f : plain.source_face) ++count_left[component(source[f])];
        Plain result;
        result.components.resize(wanted.size());
        for (std::size_t c = 0; c < wanted.size(); ++c) {
            const auto left = static_cast<double>(count_left[c]), all = static_cast<double>(count[c]);
            result.components[c] = left < (1 - least_removed) * all ? 1 : 0;
        }
        if (std::find(result.components.begin(), result.components.end(), 1) == result.components.end())
            return std::nullopt;
        faces.clear();
        for (std::size_t i = 0; i < plain.faces.size(); ++i) {
            const std::uint32_t f = source[plain.source_face[i]];
            if (result.components[component(f)] == 0) continue;
            faces.push_back(plain.faces[i]);
            result.face.push_back(f);
        }
        result.kept.assign(mesh_.vertex_count(), 0);
        for (const std::uint32_t v : plain.source_vertex) result.kept[v] = 1;

        const mesh::WorkMesh mesh = build_simplified_mesh(mesh_, plain.positions, faces, control_);
        result.found = exact::find_exact_surfaces(mesh, control_);
        control_.check();
        std::vector<std::uint32_t> of_label;
        for (const std::uint32_t f : mesh.input_face) of_label.push_back(result.face[f]);
        result.face = std::move(of_label);
        result.area = mesh.areas;
        return result;
    }

    /// Of every facet the label that has most of it, of those components that were looked at.
    std::vector<std::int32_t> label_facets(const Plain& plain) const {
        struct Share {
            std::int32_t facet, label;
            double area;
        };
        std::vector<Share> shares;
        for (std::size_t i = 0; i < plain.face.size(); ++i)
            shares.push_back({facets_.of_face[plain.face[i]], plain.found.labels[i], plain.area[i]});
        std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
            return a.facet != b.facet ? a.facet < b.facet : a.label < b.label;
        });
        std::vector<std::int32_t> result(facets_.count(), -1);
        std::vector<double> most(facets_.count(), -1);
        for (std::size_t i = 0; i < shares.size();) {
            const Share& first = shares[i];
            double area = 0;
            for (; i < shares.size() && shares[i].facet == first.facet && shares[i].label == first.label; ++i)
                area += shares[i].area;
            double& largest = most[static_cast<std::size_t>(first.facet)];
            if (area <= largest) continue;
            largest = area;
            result[static_cast<std::size_t>(first.facet)] = first.label;
        }
        return result;
    }

    /// Areas of a component that curved surfaces explain, and that nothing does.
    struct Balance {
        double curved = 0, free = 0;
    };
    std::vector<Balance> weigh(const partition::Labels& labels, const std::vector<Surface>& surfaces) const {
        std::vector<Balance> balances(mesh_.component_count);
        for (std::size_t f = 0; f < labels.size(); ++f) {
            Balance& own = balances[static_cast<std::size_t>(mesh_.components[f])];
            if (labels[f] < 0) {
                own.free += mesh_.areas[f];
            } else if (surfaces[static_cast<std::size_t>(labels[f])].type != SurfaceType::plane) {
                own.curved += mesh_.areas[f];
            }
        }
        return balances;
    }

    std::optional<DividedSurfaces> adopt(const Plain& plain) const {
        const std::vector<std::int32_t> of_facet = label_facets(plain);
        partition::Labels beneath(labels_.size(), -1);
        for (std::size_t f = 0; f < labels_.size(); ++f)
            beneath[f] = of_facet[static_cast<std::size_t>(facets_.of_face[f])];
        const std::vector<Balance> before = weigh(labels_, surfaces_), after = weigh(beneath, plain.found.surfaces);
        const auto gains = [&](std::size_t component) {
            const Balance &old = before[component], &now = after[component];
            return plain.components[component] != 0 && now.curved > least_gain * old.curved &&
                   now.free - old.free < most_price * (now.curved - old.curved);
        };
        DividedSurfaces result{labels_, surfaces_, std::vector<std::uint8_t>(mesh_.vertex_count(), 0)};
        result.surfaces.insert(result.surfaces.end(), plain.found.surfaces.begin(), plain.found.surfaces.end());
        const auto first = static_cast<std::int32_t>(surfaces_.size());
        // Only what was taken over may be changed, and is seen, when crumbs are absorbed.
        partition::Labels taken(labels_.size(), -1);
        bool any = false;
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (!gains(static_cast<std::size_t>(mesh_.components[f]))) continue;
            any = true;
            taken[f] = beneath[f];
        }
        if (!any) return std::nullopt;
        absorb_facet_crumbs(mesh_, facets_, plain.found.surfaces, control_, taken);
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (!gains(static_cast<std::size_t>(mesh_.components[f]))) continue;
            result.labels[f] = taken[f] < 0 ? -1 : first + taken[f];
            const bool curved =
                taken[f] >= 0 && plain.found.surfaces[static_cast<std::size_t>(taken[f])].type != SurfaceType::plane;
            if (!curved) continue;
            for (const std::uint32_t v : mesh_.faces[f]) result.on_facets[v] = plain.kept[v] == 0 ? 1 : 0;
        }
        return result;
    }

    const mesh::WorkMesh& mesh_;
    const runtime::RunControl& control_;
    const partition::Labels& labels_;
    const std::vector<Surface>& surfaces_;
    const exact::Tolerances& tolerances_;
    const exact::Facets& facets_;
};

}  // namespace

std::optional<DividedSurfaces> find_divided(const FlowInput& input, const exact::ExactSurfaces& exact) {
    return DividedSearch(input, exact).run();
}

}  // namespace quadseg::flow
