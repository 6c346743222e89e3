#include "partition/smooth.h"

#include "runtime/parallel.h"
#include "runtime/per_thread.h"

#include <algorithm>
#include <cmath>

namespace quadseg::partition {

namespace {

/// One unit of the paper's energies as a capacity.
constexpr double unit = 1 << 20;
/// More than any cut costs: bands have fewer than 2³² faces of an energy below 2¹⁰ each.
constexpr Capacity never = Capacity{1} << 62;
constexpr double largest_area = 1 << 10;  ///< in mean face areas

Capacity capacity_of(double energy) {
    return energy > 0 ? static_cast<Capacity>(std::min(energy, largest_area) * unit) : 0;
}

/// Ê1(x = 0), without the area: d0 / (d0 + d1).
double share(double d0, double d1, double no_distance) {
    const double sum = d0 + d1;
    return sum > no_distance && std::isfinite(sum) ? d0 / sum : 0.5;
}

/// Nodes of one side that no path within the side links to an anchored one change sides, where they have a neighbour
/// there.
void drop_islands(const BandGraph& band, std::vector<std::uint8_t>& side, std::uint8_t which) {
    const CutGraph& graph = band.graph;
    const std::vector<std::uint8_t>& anchored = which == 0 ? band.anchored0 : band.anchored1;
    std::vector<std::uint8_t> reached(side.size(), 0);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t v = 0; v < side.size(); ++v) {
        if (side[v] != which || anchored[v] == 0) continue;
        reached[v] = 1;
        stack.push_back(v);
    }
    while (!stack.empty()) {
        const std::uint32_t v = stack.back();
        stack.pop_back();
        for (std::uint32_t a = graph.begin[v]; a < graph.begin[v + 1]; ++a) {
            const std::uint32_t w = graph.head[a];
            if (side[w] != which || reached[w] != 0) continue;
            reached[w] = 1;
            stack.push_back(w);
        }
    }
    for (std::size_t v = 0; v < side.size(); ++v) {
        if (side[v] == which && reached[v] == 0) side[v] = static_cast<std::uint8_t>(1 - which);
    }
}

/// Regions that fell apart although every band stayed whole (rings cut through, junctions): small parts join the
/// neighbour with the longest common border, larger changes are taken back region by region.
class Repair {
  public:
    Repair(const mesh::WorkMesh& mesh, const Labels& before, std::size_t count)
        : mesh_(mesh), before_(before), count_(count), restored_(count, 0) {}

    void run(Labels& labels) {
        for (std::size_t round = 0; round <= count_; ++round) {
            Labels parts = labels;
            const std::size_t part_count = connected_parts({&mesh_}, parts);
            if (part_count == count_ && all_present(labels)) return;
            if (!restore_regions_that_lost_their_core(labels, parts, part_count)) {
                join_strays(labels, parts, part_count);
                return;
            }
        }
    }

  private:
    bool all_present(const Labels& labels) const {
        std::vector<std::uint8_t> seen(count_, 0);
        for (const std::int32_t label : labels) {
            if (label >= 0) seen[static_cast<std::size_t>(label)] = 1;
        }
        return std::find(seen.begin(), seen.end(), 0) == seen.end();
    }

    /// Part of each region with the most faces that it had before.
    std::vector<std::int32_t> main_parts(const Labels& labels, const Labels& parts, std::size_t part_count) {
        std::vector<std::uint32_t> kept(part_count, 0);
        std::vector<std::int32_t> region(part_count, -1);
        for (std::size_t f = 0; f < labels.size(); ++f) {
            if (labels[f] < 0) continue;
            region[static_cast<std::size_t>(parts[f])] = labels[f];
            kept[static_cast<std::size_t>(parts[f])] += labels[f] == before_[f] ? 1U : 0U;
        }
        std::vector<std::int32_t> main(count_, -1);
        for (std::size_t p = 0; p < part_count; ++p) {
            if (region[p] < 0) continue;
            std::int32_t& best = main[static_cast<std::size_t>(region[p])];
            if (best < 0 || kept[p] > kept[static_cast<std::size_t>(best)]) best = static_cast<std::int32_t>(p);
        }
        kept_ = std::move(kept);
        return main;
    }

    /// A region that is gone, or a part of which was its own before and is no crumb, gets its old faces back.
    bool restore_regions_that_lost_their_core(Labels& labels, const Labels& parts, std::size_t part_count) {
        constexpr std::uint32_t crumb = 4;
        const std::vector<std::int32_t> main = main_parts(labels, parts, part_count);
        std::vector<std::uint8_t> bad(count_, 0);
        for (std::size_t r = 0; r < count_; ++r) bad[r] = main[r] < 0 ? 1 : 0;
        for (std::size_t f = 0; f < labels.size(); ++f) {
            if (labels[f] < 0) continue;
            const auto r = static_cast<std::size_t>(labels[f]);
            if (parts[f] != main[r] && kept_[static_cast<std::size_t>(parts[f])] > crumb) bad[r] = 1;
        }
        bool news = false;
        for (std::size_t r = 0; r < count_; ++r) {
            if (bad[r] == 0 || restored_[r] != 0) continue;
            restored_[r] = 1;
            news = true;
        }
        if (!news) return false;
        for (std::size_t f = 0; f < labels.size(); ++f) {
            if (labels[f] == before_[f] || labels[f] < 0) continue;
            if (restored_[static_cast<std::size_t>(labels[f])] != 0 ||
                restored_[static_cast<std::size_t>(before_[f])] != 0)
                labels[f] = before_[f];
        }
        return true;
    }

    void join_strays(Labels& labels, const Labels& parts, std::size_t part_count) {
        const std::vector<std::int32_t> main = main_parts(labels, parts, part_count);
        const auto stray = [&](std::size_t f) {
            return labels[f] >= 0 && parts[f] != main[static_cast<std::size_t>(labels[f])];
        };
        // (part, label beyond) → length, by sorting.
        struct Contact {
            std::int32_t part, label;
            double length;
        };
        std::vector<Contact> contacts;
        for (std::size_t f = 0; f < labels.size(); ++f) {
            if (!stray(f)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                if (g < 0 || parts[static_cast<std::size_t>(g)] == parts[f] || stray(static_cast<std::size_t>(g)))
                    continue;
                const Vec3 edge = mesh_.corner(f, static_cast<int>(k)) - mesh_.corner(f, static_cast<int>((k + 1) % 3));
                contacts.push_back({parts[f], labels[static_cast<std::size_t>(g)], norm(edge)});
            }
        }
        std::stable_sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
            return a.part != b.part ? a.part < b.part : a.label < b.label;
        });
        std::vector<std::int32_t> home(part_count, -1);
        std::vector<double> best(part_count, -1);
        for (std::size_t begin = 0, end = 0; begin < contacts.size(); begin = end) {
            double length = 0;
            for (; end < contacts.size() && contacts[end].part == contacts[begin].part &&
                   contacts[end].label == contacts[begin].label;
                 ++end) {
                length += contacts[end].length;
            }
            const auto p = static_cast<std::size_t>(contacts[begin].part);
            if (!(length > best[p])) continue;
            best[p] = length;
            home[p] = contacts[begin].label;
        }
        for (std::size_t f = 0; f < labels.size(); ++f) {
            if (stray(f) && home[static_cast<std::size_t>(parts[f])] >= 0)
                labels[f] = home[static_cast<std::size_t>(parts[f])];
        }
    }

    const mesh::WorkMesh& mesh_;
    const Labels& before_;
    std::size_t count_;
    std::vector<std::uint8_t> restored_;
    std::vector<std::uint32_t> kept_;
};

}  // namespace

double mean_edge_length(const mesh::WorkMesh& mesh) {
    const double sum = runtime::reduce_blocks(
        mesh.face_count(), 8192, 0.0,
        [&](std::size_t begin, std::size_t end) {
            double part = 0;
            for (std::size_t f = begin; f < end; ++f) {
                for (int k = 0; k < 3; ++k) part += norm(mesh.corner(f, k) - mesh.corner(f, (k + 1) % 3));
            }
            return part;
        },
        [](double a, double b) { return a + b; });
    return mesh.face_count() > 0 ? sum / (3 * static_cast<double>(mesh.face_count())) : 0;
}

BandGraph band_graph(const Passage& passage, const Labels& labels, const BorderBands& bands, std::size_t pair,
                     const FaceDistance& distance, const SmoothRules& rules, double mean_edge, double mean_area,
                     std::vector<std::int32_t>& local) {
    const auto [a, b] = bands.pairs[pair];
    BandGraph band;
    for (std::uint32_t i = bands.begin[pair]; i < bands.begin[pair + 1]; ++i) {
        const std::uint32_t f = bands.face[i];
        if (labels[f] != a && labels[f] != b) continue;  // taken by another region since
        local[f] = static_cast<std::int32_t>(band.nodes.size());
        band.nodes.push_back(f);
    }
    const std::size_t nodes = band.nodes.size();
    CutGraph& graph = band.graph;
    graph.side0.assign(nodes, 0);
    graph.side1.assign(nodes, 0);
    band.anchored0.assign(nodes, 0);
    band.anchored1.assign(nodes, 0);
    graph.begin.assign(1, 0);
    graph.head.reserve(3 * nodes);
    graph.capacity.reserve(3 * nodes);
    const mesh::WorkMesh& mesh = *passage.mesh;
    // The face of each side that suits it best, and whether the side has any V0 or V1.
    std::int32_t best[2] = {-1, -1};
    double best_share[2] = {2, 2};
    bool has_anchor[2] = {false, false};
    for (std::size_t v = 0; v < nodes; ++v) {
        const std::uint32_t f = band.nodes[v];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = passage.across(f, k);
            if (g < 0) continue;
            const std::int32_t other = labels[static_cast<std::size_t>(g)];
            if (other != a && other != b) continue;
            const double length =
                norm(mesh.corner(f, static_cast<int>(k)) - mesh.corner(f, static_cast<int>((k + 1) % 3)));
            const Capacity cost = capacity_of(rules.lambda * (length > 0 ? length / (length + mean_edge) : 0));
            const std::int32_t w = local[static_cast<std::size_t>(g)];
            if (w < 0) {  // V0 or V1
                const int side = other == a ? 0 : 1;
                (side == 0 ? graph.side0 : graph.side1)[v] += cost;
                (side == 0 ? band.anchored0 : band.anchored1)[v] = 1;
                has_anchor[side] = true;
                continue;
            }
            const auto to = static_cast<std::uint32_t>(w);
            const auto known = std::find(graph.head.begin() + graph.begin[v], graph.head.end(), to);
            if (known == graph.head.end()) {
                graph.head.push_back(to);
                graph.capacity.push_back(cost);
            } else {  // two faces with two common edges
                graph.capacity[static_cast<std::size_t>(known - graph.head.begin())] += cost;
            }
        }
        graph.begin.push_back(static_cast<std::uint32_t>(graph.head.size()));
        const double d0 = std::abs(distance(f, a)), d1 = std::abs(distance(f, b));
        const double e0 = share(d0, d1, rules.no_distance), area = mean_area > 0 ? mesh.areas[f] / mean_area : 1;
        graph.side1[v] += capacity_of(area * e0);
        graph.side0[v] += capacity_of(area * (1 - e0));
        const int own = labels[f] == a ? 0 : 1;
        const double own_share = own == 0 ? e0 : 1 - e0;
        if (own_share < best_share[own]) {
            best_share[own] = own_share;
            best[own] = static_cast<std::int32_t>(v);
        }
    }
    for (int side = 0; side < 2; ++side) {
        if (has_anchor[side] || best[side] < 0) continue;
        const auto v = static_cast<std::size_t>(best[side]);
        (side == 0 ? graph.side0 : graph.side1)[v] = never;
        (side == 0 ? band.anchored0 : band.anchored1)[v] = 1;
    }
    for (const std::uint32_t f : band.nodes) local[f] = -1;
    return band;
}

std::size_t smooth_borders(const Passage& passage, Labels& labels, std::size_t count, const FaceDistance& distance,
                           const SmoothRules& rules, const runtime::RunControl& control) {
    const mesh::WorkMesh& mesh = *passage.mesh;
    const BorderBands bands = find_border_bands(passage, labels, std::max(rules.band, 1), control);
    const double mean_edge = mean_edge_length(mesh);
    const double mean_area = mesh.total_area / static_cast<double>(std::max<std::size_t>(mesh.face_count(), 1));
    Labels result = labels;
    runtime::PerThread<std::vector<std::int32_t>> locals;
    for (std::size_t batch = 0; batch < bands.batch_count(); ++batch) {
        const std::uint32_t first = bands.batch_begin[batch];
        runtime::parallel_for(bands.batch_begin[batch + 1] - first, 1, [&](std::size_t i) {
            control.check();
            const std::size_t pair = bands.batch_pair[first + i];
            std::vector<std::int32_t>& local = locals.local();
            if (local.empty()) local.assign(labels.size(), -1);
            const BandGraph band =
                band_graph(passage, result, bands, pair, distance, rules, mean_edge, mean_area, local);
            std::vector<std::uint8_t> side = minimum_cut(band.graph);
            drop_islands(band, side, 0);
            drop_islands(band, side, 1);
            for (std::size_t v = 0; v < side.size(); ++v) {
                result[band.nodes[v]] = side[v] == 0 ? bands.pairs[pair].a : bands.pairs[pair].b;
            }
        });
    }
    Repair(mesh, labels, count).run(result);
    std::size_t changed = 0;
    for (std::size_t f = 0; f < labels.size(); ++f) changed += result[f] != labels[f] ? 1U : 0U;
    labels = std::move(result);
    return changed;
}

}  // namespace quadseg::partition
