#include "exact/unite.h"

#include "exact/face_fit.h"
#include "exact/grow.h"
#include "runtime/parallel.h"
#include "runtime/per_thread.h"
#include "surface/fit.h"

#include <algorithm>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace quadseg::exact {

namespace {

constexpr std::size_t sample = 1000;
/// In tolerances for trim curves: what the worst are off by (1e-4 of the diagonal, where a modeller approximated them).
constexpr double worst_trim = 16;
constexpr std::size_t scrap_faces = 8;
constexpr double enclosing_share = 0.34;

std::vector<std::vector<std::uint32_t>> faces_of_regions(const Explained& state) {
    std::vector<std::vector<std::uint32_t>> faces(state.surface.size());
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] >= 0)
            faces[static_cast<std::size_t>(state.region[f])].push_back(static_cast<std::uint32_t>(f));
    }
    return faces;
}

struct Border {
    std::int32_t a, b;  ///< a < b
    double bend = 0;    ///< largest dihedral angle along it

    bool operator<(const Border& other) const { return a != other.a ? a < other.a : b < other.b; }
};

/// One a pair of regions, in their order.
void merge_equal(std::vector<Border>& borders) {
    std::sort(borders.begin(), borders.end());
    std::size_t count = 0;
    for (const Border& border : borders) {
        if (count > 0 && borders[count - 1].a == border.a && borders[count - 1].b == border.b) {
            borders[count - 1].bend = std::max(borders[count - 1].bend, border.bend);
        } else {
            borders[count++] = border;
        }
    }
    borders.resize(count);
}

std::vector<Border> borders_of(const Scene& scene, const Explained& state) {
    constexpr std::size_t block = 16384;
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Border>& own) {
        scene.control.check();
        for (std::size_t f = begin; f < end; ++f) {
            for (const std::int32_t g : scene.mesh.neighbors[f]) {
                if (g < 0) continue;
                const std::int32_t a = state.region[f], b = state.region[static_cast<std::size_t>(g)];
                if (a >= 0 && a < b) own.push_back({a, b, dihedral(scene.mesh, f, static_cast<std::size_t>(g))});
            }
        }
        merge_equal(own);
    };
    std::vector<Border> borders = runtime::collect_blocks<Border>(state.region.size(), block, find);
    merge_equal(borders);
    return borders;
}

/// Passes over the borders until no pair unites. What becomes of a pair depends on its two regions and their border
/// alone: that of those as they are at a pass's start is found by all threads, and taken in order where none of the two
/// has changed meanwhile; pairs that stay apart are asked again only after one has changed.
class Uniter {
  public:
    Uniter(const Scene& scene, double largest_step, Explained& state)
        : scene_(scene), largest_step_(largest_step), state_(state), faces_(faces_of_regions(state)) {
        parent_.resize(state.surface.size());
        std::iota(parent_.begin(), parent_.end(), 0);
        changes_.resize(state.surface.size(), 0);
    }

    void run() {
        for (bool any = true; any;) {
            any = false;
            scene_.control.check();
            const std::vector<Border> borders = borders_of(scene_, state_);
            std::vector<Verdict> verdicts(borders.size());
            runtime::parallel_for(borders.size(), 1, [&](std::size_t i) {
                scene_.control.check();
                verdicts[i] = judge(borders[i]);
            });
            for (std::size_t i = 0; i < borders.size(); ++i) {
                scene_.control.check();
                const Border border{find(borders[i].a), find(borders[i].b), borders[i].bend};
                if (border.a == border.b) continue;
                const bool valid =
                    border.a == borders[i].a && border.b == borders[i].b && verdicts[i].changes == changes_of(border);
                if (!valid) verdicts[i] = judge(border);
                if (verdicts[i].surface) {
                    any = true;
                    join(border, *verdicts[i].surface);
                } else {
                    apart_[{border.a, border.b}] = {verdicts[i].changes, border.bend};
                }
            }
            for (std::int32_t& r : state_.region) {
                if (r >= 0) r = find(r);
            }
        }
    }

  private:
    using Changes = std::pair<std::uint32_t, std::uint32_t>;
    struct Verdict {
        std::unique_ptr<const Surface> surface;  ///< of both as one; none: they stay apart
        Changes changes;                         ///< of the two regions, up to when it was found
    };
    struct Apart {
        Changes changes;
        double bend;
        bool operator==(const Apart&) const = default;
    };

    std::int32_t find(std::int32_t r) const {
        while (parent_[static_cast<std::size_t>(r)] != r) r = parent_[static_cast<std::size_t>(r)];
        return r;
    }
    const std::vector<std::uint32_t>& faces(std::int32_t r) const { return faces_[static_cast<std::size_t>(r)]; }
    const Surface& surface(std::int32_t r) const { return state_.surface[static_cast<std::size_t>(r)]; }
    Changes changes_of(const Border& border) const {
        return {changes_[static_cast<std::size_t>(border.a)], changes_[static_cast<std::size_t>(border.b)]};
    }
    /// The larger region first.
    std::pair<std::int32_t, std::int32_t> by_size(const Border& border) const {
        if (faces(border.a).size() < faces(border.b).size()) return {border.b, border.a};
        return {border.a, border.b};
    }

    Verdict judge(const Border& border) {
        const Changes changes = changes_of(border);
        const auto apart = apart_.find({border.a, border.b});
        if (apart != apart_.end() && apart->second == Apart{changes, border.bend}) return {nullptr, changes};
        const std::optional<Surface> common = common_surface(border);
        return {common ? std::make_unique<const Surface>(*common) : nullptr, changes};
    }

    std::optional<Surface> common_surface(const Border& border) {
        const auto [a, b] = by_size(border);
        const double tolerance = std::max(3e-6 * scene_.tolerances.diagonal, 10 * scene_.tolerances.precision);
        if (lies_on(b, surface(a), tolerance, 0.9) || passes_for(b, surface(a), tolerance)) {
            if (is_flat_on(a, b)) return std::nullopt;
            return surface(a);
        }
        // Small pieces say too little alone; together they may fit one surface, if the border between them is smooth.
        if (faces(b).size() > 64 || border.bend > std::max(largest_step_, 0.1)) return std::nullopt;
        const Surface* curved = &surface(a);
        if (curved->type == SurfaceType::plane) return std::nullopt;
        std::vector<std::uint32_t> both = faces(a);
        both.insert(both.end(), faces(b).begin(), faces(b).end());
        const std::vector<Vec3> points = vertices_of(scene_, both, sample, marks_.local());
        const surface::SurfaceFit fit = surface::refine(*curved, {points, {}, {}}, {});
        if (!fit.ok || fit.q90 > scene_.tolerances.loose_fit || fit.max > scene_.tolerances.trim) return std::nullopt;
        if (!lies_on(a, fit.surface, scene_.tolerances.trim, 1) ||
            !lies_on(b, fit.surface, scene_.tolerances.trim, 1)) {
            return std::nullopt;
        }
        return fit.surface;
    }

    /// A plane whose edges lie on a ruled surface, which its own facets follow closer.
    bool is_flat_on(std::int32_t ruled, std::int32_t plane) const {
        const Surface& s = surface(ruled);
        if (surface(plane).type != SurfaceType::plane || s.type == SurfaceType::plane) return false;
        const FaceFitter fitter(scene_, s);
        const std::vector<std::uint32_t>& list = faces(ruled);
        const std::size_t stride = std::max<std::size_t>(1, list.size() / sample);
        std::vector<std::pair<double, double>> steps;
        for (std::size_t i = 0; i < list.size(); i += stride)
            steps.emplace_back(fitter(list[i]).step, scene_.mesh.areas[list[i]]);
        const double typical = typical_step(std::move(steps));
        return std::any_of(faces(plane).begin(), faces(plane).end(),
                           [&](std::uint32_t f) { return is_flat_cut(scene_, f, fitter(f), s.type, typical); });
    }

    /// `share` of the vertices within the tolerance, and nearly all of the area with a fitting normal.
    bool lies_on(std::int32_t region, const Surface& s, double tolerance, double share) const {
        const FaceFitter fitter(scene_, s);
        const std::vector<std::uint32_t>& list = faces(region);
        const std::size_t stride = std::max<std::size_t>(1, list.size() / sample);
        const std::size_t tests = (list.size() + stride - 1) / stride;
        std::size_t off = 0, turned = 0, steep = 0;
        // Most pairs of neighbours are decided by the first few faces.
        for (std::size_t i = 0; i < list.size(); i += stride) {
            for (const std::uint32_t v : scene_.mesh.faces[list[i]])
                off += fitter.vertex_distance(v) <= tolerance ? 0 : 1;
            if (static_cast<double>(3 * tests - off) < share * static_cast<double>(3 * tests)) return false;
            const FaceFit fit = fitter(list[i]);
            turned += fit.angle > fit.allowed || fitter.spans_a_hole(list[i], fit) ? 1 : 0;
            steep += s.type != SurfaceType::plane && fit.step > 1.7 * largest_step_ ? 1 : 0;
            if (10 * turned > tests || 10 * steep > tests) return false;
        }
        return true;
    }

    /// lies_on() for a region with ends that are badly trimmed: the vertices that lie on its own surface count, if they
    /// are a good part, and all of its faces run along the other one.
    bool passes_for(std::int32_t region, const Surface& s, double tolerance) const {
        const Surface& own = surface(region);
        if (s.type != own.type || s.type == SurfaceType::plane) return false;
        const FaceFitter fitter(scene_, s), own_fitter(scene_, own);
        const std::vector<std::uint32_t>& list = faces(region);
        const std::size_t stride = std::max<std::size_t>(1, list.size() / sample);
        std::size_t corners = 0, exact = 0;
        for (std::size_t i = 0; i < list.size(); i += stride) {
            const FaceFit fit = fitter(list[i]);
            if (!fit.within(worst_trim * scene_.tolerances.trim) || fit.step > 1.7 * largest_step_) return false;
            for (const std::uint32_t v : scene_.mesh.faces[list[i]]) {
                ++corners;
                if (own_fitter.vertex_distance(v) > scene_.tolerances.loose_fit) continue;
                ++exact;
                if (fitter.vertex_distance(v) > tolerance) return false;
            }
        }
        return 3 * exact >= corners;
    }

    void join(const Border& border, const Surface& s) {
        const auto [larger, smaller] = by_size(border);
        const auto a = static_cast<std::size_t>(larger), b = static_cast<std::size_t>(smaller);
        state_.surface[a] = s;
        faces_[a].insert(faces_[a].end(), faces_[b].begin(), faces_[b].end());
        faces_[b].clear();
        parent_[b] = larger;
        ++changes_[a];
    }

    const Scene& scene_;
    double largest_step_;
    Explained& state_;
    std::vector<std::vector<std::uint32_t>> faces_;
    std::vector<std::int32_t> parent_;
    std::vector<std::uint32_t> changes_;  ///< a region: how often it took another one
    std::map<std::pair<std::int32_t, std::int32_t>, Apart> apart_;
    runtime::PerThread<Marks> marks_;
};

/// The neighbouring region with the longest common border, its share of the perimeter.
struct Host {
    std::int32_t region = -1;
    double share = 0;
    double bend = 1e9;
};

std::vector<Host> hosts_of(const Scene& scene, const Explained& state, const std::vector<std::uint32_t>& piece) {
    std::map<std::int32_t, Host> hosts;
    double perimeter = 0;
    std::vector<std::uint32_t> sorted = piece;
    std::sort(sorted.begin(), sorted.end());
    for (const std::uint32_t f : piece) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g >= 0 && std::binary_search(sorted.begin(), sorted.end(), static_cast<std::uint32_t>(g))) continue;
            const double length = norm(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
            perimeter += length;
            if (g < 0 || state.region[static_cast<std::size_t>(g)] < 0) continue;
            Host& host = hosts[state.region[static_cast<std::size_t>(g)]];
            host.region = state.region[static_cast<std::size_t>(g)];
            host.share += length;
            host.bend = std::min(host.bend, dihedral(scene.mesh, f, static_cast<std::size_t>(g)));
        }
    }
    std::vector<Host> list;
    for (auto& [region, host] : hosts) {
        host.share /= std::max(perimeter, 1e-300);
        list.push_back(host);
    }
    return list;
}

bool explains(const Scene& scene, const Explained& state, std::int32_t region,
              const std::vector<std::uint32_t>& piece) {
    const FaceFitter fitter(scene, state.surface[static_cast<std::size_t>(region)]);
    return std::all_of(piece.begin(), piece.end(),
                       [&](std::uint32_t f) { return fitter.distance(f) <= scene.tolerances.border; });
}

double largest_distance(const Scene& scene, const Surface& surface, const std::vector<std::uint32_t>& faces) {
    const FaceFitter fitter(scene, surface);
    double largest = 0;
    std::size_t polls = 0;
    for (const std::uint32_t f : faces) {
        scene.control.check_often(polls);
        largest = std::max(largest, fitter.distance(f));
    }
    return largest;
}

/// Two coplanar triangles, no smaller than a curved region's, are a flat where its surface, on which its own vertices
/// lie, comes no nearer, or its facets turn less than they would.
template <class OwnDistance>
bool is_flat_scrap(const Scene& scene, const Surface& curved, double largest_step, const OwnDistance& own_distance,
                   double face_area, const std::vector<std::uint32_t>& piece) {
    if (curved.type == SurfaceType::plane || piece.size() < 2) return false;
    if (scene.mesh.areas[piece[0]] + scene.mesh.areas[piece[1]] < 2 * face_area) return false;
    const FaceFitter fitter(scene, curved);
    const double trim = scene.tolerances.trim;
    return std::any_of(piece.begin(), piece.end(), [&](std::uint32_t f) {
        const FaceFit fit = fitter(f);
        return fit.step > 1.7 * largest_step || (fit.distance > trim && own_distance() <= trim);
    });
}

std::size_t facets_of(const Scene& scene, const std::vector<std::uint32_t>& piece) {
    std::vector<std::int32_t> facets;
    facets.reserve(piece.size());
    for (const std::uint32_t f : piece) facets.push_back(scene.facets.of_face[f]);
    std::sort(facets.begin(), facets.end());
    return static_cast<std::size_t>(std::unique(facets.begin(), facets.end()) - facets.begin());
}

/// One facet of several faces, whose area is many times that of a face beside it.
bool is_large_flat(const Scene& scene, const std::vector<std::uint32_t>& piece, double face_area) {
    constexpr double large = 16;
    double area = 0;
    for (const std::uint32_t f : piece) {
        if (scene.facets.of_face[f] != scene.facets.of_face[piece.front()]) return false;
        area += scene.mesh.areas[f];
    }
    return piece.size() > 1 && area > large * face_area;
}

/// All vertices of a piece lie on a surface to the last digit, and its faces along it as far as slivers can.
bool lies_exactly_on(const Scene& scene, const Surface& surface, const std::vector<std::uint32_t>& piece) {
    constexpr double largest_tilt = 45 * std::numbers::pi / 180;
    const FaceFitter fitter(scene, surface);
    return std::all_of(piece.begin(), piece.end(), [&](std::uint32_t f) {
        const FaceFit fit = fitter(f);
        return fit.distance <= scene.tolerances.fit && fit.angle <= largest_tilt;
    });
}

}  // namespace

void absorb_exact_crumbs(const Scene& scene, Explained& state) {
    constexpr int passes = 3;
    constexpr std::size_t largest_crumb = 24, host_to_crumb = 4;
    for (int pass = 0; pass < passes; ++pass) {
        const std::vector<std::vector<std::uint32_t>> regions = faces_of_regions(state);
        bool any = false;
        for (std::size_t r = 0; r < regions.size(); ++r) {
            scene.control.check();
            const std::vector<std::uint32_t>& piece = regions[r];
            // A flat whose corners lie on a cylinder is a flat.
            if (piece.empty() || piece.size() > largest_crumb || state.surface[r].type == SurfaceType::plane) continue;
            std::vector<Host> hosts = hosts_of(scene, state, piece);
            std::stable_sort(hosts.begin(), hosts.end(),
                             [](const Host& a, const Host& b) { return a.share > b.share; });
            for (const Host& host : hosts) {
                const auto h = static_cast<std::size_t>(host.region);
                const bool larger = regions[h].size() >= host_to_crumb * piece.size();
                if (h == r || !larger || state.surface[h].type == SurfaceType::plane) continue;
                if (!lies_exactly_on(scene, state.surface[h], piece)) continue;
                for (const std::uint32_t f : piece) state.region[f] = host.region;
                any = true;
                break;
            }
        }
        if (!any) break;
    }
    separate_parts(scene, state);
}

void unite_equal(const Scene& scene, double largest_step, Explained& state) {
    Uniter(scene, largest_step, state).run();
    separate_parts(scene, state);
}

void absorb_badly_trimmed(const Scene& scene, double largest_step, Explained& state) {
    constexpr double least_share = 0.2, gentle = 10 * std::numbers::pi / 180;
    const double tolerance = worst_trim * scene.tolerances.trim;
    for (const std::vector<std::uint32_t>& piece : free_components(scene, state, true)) {
        scene.control.check();
        if (facets_of(scene, piece) < 3) continue;  // a narrow plane between fillets lies as near
        std::vector<Host> hosts = hosts_of(scene, state, piece);
        std::stable_sort(hosts.begin(), hosts.end(), [](const Host& a, const Host& b) { return a.share > b.share; });
        for (const Host& host : hosts) {
            const Surface& surface = state.surface[static_cast<std::size_t>(host.region)];
            if (host.share < least_share) break;
            if (host.bend > gentle || surface.type == SurfaceType::plane) continue;
            const FaceFitter fitter(scene, surface);
            const bool lies_on = std::all_of(piece.begin(), piece.end(), [&](std::uint32_t f) {
                const FaceFit fit = fitter(f);
                return fit.within(tolerance) && fit.step <= 1.7 * largest_step;
            });
            if (!lies_on) continue;
            for (const std::uint32_t f : piece) state.region[f] = host.region;
            break;
        }
    }
}

void absorb_scraps(const Scene& scene, double largest_step, Explained& state) {
    std::vector<std::vector<std::uint32_t>> pieces = free_components(scene, state, false);
    const std::size_t free_pieces = pieces.size();
    const std::vector<std::vector<std::uint32_t>> regions = faces_of_regions(state);
    std::vector<double> mean_area;
    std::vector<std::optional<double>> known_distance(regions.size());
    const auto own_distance = [&](std::size_t r) {
        if (r >= regions.size()) return 0.0;
        if (!known_distance[r]) known_distance[r] = largest_distance(scene, state.surface[r], regions[r]);
        return *known_distance[r];
    };
    for (const std::vector<std::uint32_t>& faces : regions) {
        double area = 0;
        for (const std::uint32_t f : faces) area += scene.mesh.areas[f];
        mean_area.push_back(area / static_cast<double>(std::max<std::size_t>(1, faces.size())));
        const bool tiny = faces.size() <= 2 && !faces.empty();
        if (tiny) pieces.push_back(faces);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        scene.control.check();
        const std::vector<std::uint32_t>& piece = pieces[i];
        if (piece.size() > scrap_faces) continue;
        std::vector<Host> hosts = hosts_of(scene, state, piece);
        std::stable_sort(hosts.begin(), hosts.end(), [](const Host& a, const Host& b) { return a.share > b.share; });
        const auto host = std::find_if(hosts.begin(), hosts.end(), [&](const Host& h) {
            const auto r = static_cast<std::size_t>(h.region);
            return h.share >= enclosing_share && explains(scene, state, h.region, piece) &&
                   (i < free_pieces ||
                    !is_flat_scrap(
                        scene, state.surface[r], largest_step, [&] { return own_distance(r); }, mean_area[r], piece));
        });
        std::int32_t target = host != hosts.end() ? host->region : -1;
        if (target < 0 && i < free_pieces && piece.size() < 4 && !hosts.empty()) {
            target = std::min_element(hosts.begin(), hosts.end(), [](const Host& a, const Host& b) {
                         return a.bend < b.bend;
                     })->region;
        }
        if (target < 0) continue;
        // A large flat beside small facets is a face of its own, however smoothly it goes on.
        if (host == hosts.end() && is_large_flat(scene, piece, mean_area[static_cast<std::size_t>(target)])) {
            const Facet& facet = scene.facets.facet[static_cast<std::size_t>(scene.facets.of_face[piece.front()])];
            Surface plane;
            plane.type = SurfaceType::plane;
            plane.axis = to_array(facet.normal);
            plane.point = to_array(facet.normal * facet.offset);
            target = state.add(plane);
            mean_area.push_back(0);
        }
        for (const std::uint32_t f : piece) state.region[f] = target;
    }
    separate_parts(scene, state);
}

}  // namespace quadseg::exact
