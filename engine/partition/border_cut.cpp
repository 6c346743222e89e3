#include "partition/border_cut.h"

#include "partition/band_cut.h"
#include "runtime/parallel.h"
#include "runtime/per_thread.h"

#include <algorithm>

namespace quadseg::partition {
namespace {

class BorderCutter {
  public:
    BorderCutter(const Passage& passage, const Labels& labels, std::span<const quadric::RegionFit> fits,
                 const BorderCutOptions& options)
        : passage_(passage), mesh_(*passage.mesh), labels_(labels), fits_(fits), options_(options) {}

    /// Pairs of regions with their border faces, ascending.
    std::vector<BorderCut> pairs(std::span<const std::uint32_t> border_faces,
                                 const runtime::RunControl& control) const {
        struct Key {
            std::int32_t b;
            std::uint32_t face;
        };
        std::size_t polls = 0;
        const auto for_sides = [&](const auto& visit) {
            for (const std::uint32_t f : border_faces) {
                control.check_often(polls);
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(f, k);
                    const std::int32_t other = g < 0 ? -1 : labels_[static_cast<std::size_t>(g)];
                    if (other >= 0 && other != labels_[f]) visit(f, std::minmax(other, labels_[f]));
                }
            }
        };
        // Sorted by the smaller region first, by counting: one sort of all would take long, and could not be stopped.
        std::vector<std::size_t> begin(fits_.size() + 1, 0);
        for_sides([&](std::uint32_t, const auto& pair) { ++begin[static_cast<std::size_t>(pair.first)]; });
        std::vector<Key> keys(runtime::exclusive_scan(begin));
        std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
        for_sides([&](std::uint32_t f, const auto& pair) {
            keys[next[static_cast<std::size_t>(pair.first)]++] = {pair.second, f};
        });
        std::vector<BorderCut> result;
        for (std::size_t a = 0; a + 1 < begin.size(); ++a) {
            control.check_often(polls);
            const auto first = keys.begin() + static_cast<std::ptrdiff_t>(begin[a]);
            const auto last = keys.begin() + static_cast<std::ptrdiff_t>(begin[a + 1]);
            std::sort(first, last, [](const Key& x, const Key& y) { return x.b != y.b ? x.b < y.b : x.face < y.face; });
            for (auto key = first; key != last; ++key) {
                if (key == first || key->b != result.back().b) {
                    result.push_back({static_cast<std::int32_t>(a), key->b, {}});
                }
                std::vector<std::uint32_t>& faces = result.back().faces;
                if (faces.empty() || faces.back() != key->face) faces.push_back(key->face);
            }
        }
        return result;
    }

    struct Scratch {
        BandCut cut;
        std::vector<std::int32_t> node;  ///< of a face; −1: not in the band
    };

    /// From the border faces of a pair to the faces that change sides.
    void cut(BorderCut& pair, Scratch& scratch) const {
        if (scratch.node.empty()) scratch.node.assign(labels_.size(), -1);
        widen(pair, scratch.node);
        build(pair, scratch);
        const std::vector<std::uint8_t>& side = scratch.cut.solve();
        std::size_t kept = 0;
        for (std::size_t i = 0; i < pair.faces.size(); ++i) {
            const std::uint32_t f = pair.faces[i];
            scratch.node[f] = -1;
            if (labels_[f] != (side[i] == 0 ? pair.a : pair.b)) pair.faces[kept++] = f;
        }
        pair.faces.resize(kept);
    }

  private:
    void widen(BorderCut& pair, std::vector<std::int32_t>& node) const {
        for (std::size_t i = 0; i < pair.faces.size(); ++i) node[pair.faces[i]] = static_cast<std::int32_t>(i);
        std::size_t ring_begin = 0;
        for (int ring = 0; ring < options_.rings; ++ring) {
            const std::size_t ring_end = pair.faces.size();
            for (std::size_t i = ring_begin; i < ring_end; ++i) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(pair.faces[i], k);
                    if (g < 0) continue;
                    const auto u = static_cast<std::size_t>(g);
                    if (node[u] >= 0 || (labels_[u] != pair.a && labels_[u] != pair.b)) continue;
                    node[u] = static_cast<std::int32_t>(pair.faces.size());
                    pair.faces.push_back(static_cast<std::uint32_t>(u));
                }
            }
            ring_begin = ring_end;
        }
    }

    void build(const BorderCut& pair, Scratch& scratch) const {
        scratch.cut.clear();
        for (const std::uint32_t f : pair.faces) {
            double in_a = energy(f, pair.a), in_b = energy(f, pair.b);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(f, k);
                if (g < 0 || scratch.node[static_cast<std::size_t>(g)] >= 0) continue;
                const double price = edge_price(f, k, static_cast<std::size_t>(g), pair);
                if (labels_[static_cast<std::size_t>(g)] == pair.a) in_b += price;
                if (labels_[static_cast<std::size_t>(g)] == pair.b) in_a += price;
            }
            scratch.cut.add_node(in_a, in_b);
        }
        for (std::size_t i = 0; i < pair.faces.size(); ++i) {
            const std::size_t f = pair.faces[i];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(f, k);
                if (g < 0) continue;
                const std::int32_t j = scratch.node[static_cast<std::size_t>(g)];
                if (j <= static_cast<std::int32_t>(i)) continue;
                const auto& back = mesh_.neighbors[static_cast<std::size_t>(g)];
                const auto slot = static_cast<std::size_t>(
                    std::find(back.begin(), back.end(), static_cast<std::int32_t>(f)) - back.begin());
                if (slot >= 3) continue;
                scratch.cut.add_edge(i, k, static_cast<std::size_t>(j), slot,
                                     edge_price(f, k, static_cast<std::size_t>(g), pair));
            }
        }
    }

    double energy(std::size_t f, std::int32_t label) const noexcept {
        return quadric::triangle_energy(fits_[static_cast<std::size_t>(label)].proxy, mesh_.corner(f, 0),
                                        mesh_.corner(f, 1), mesh_.corner(f, 2), mesh_.normals[f], mesh_.areas[f])
            .hybrid(options_.weight);
    }
    double edge_price(std::size_t f, std::size_t k, std::size_t g, const BorderCut& pair) const noexcept {
        return options_.border.of_edge(mesh_, f, k, g, fits_[static_cast<std::size_t>(pair.a)].proxy,
                                       fits_[static_cast<std::size_t>(pair.b)].proxy);
    }

    const Passage& passage_;
    const mesh::WorkMesh& mesh_;
    const Labels& labels_;
    std::span<const quadric::RegionFit> fits_;
    const BorderCutOptions& options_;
};

}  // namespace

std::vector<BorderCut> cut_borders(const Passage& passage, const Labels& labels,
                                   std::span<const quadric::RegionFit> fits, const BorderCutOptions& options,
                                   std::span<const std::uint32_t> border_faces, const runtime::RunControl& control) {
    const BorderCutter cutter(passage, labels, fits, options);
    std::vector<BorderCut> cuts = cutter.pairs(border_faces, control);
    runtime::PerThread<BorderCutter::Scratch> scratch;
    runtime::parallel_for(cuts.size(), 1, [&](std::size_t i) {
        control.check();
        cutter.cut(cuts[i], scratch.local());
    });
    return cuts;
}

}  // namespace quadseg::partition
