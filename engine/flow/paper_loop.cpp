#include "flow/paper_loop.h"

#include "partition/insert.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace quadseg::flow {

namespace {

/// Energies below are rounding: nothing left to converge (unit cube).
constexpr double zero_energy = 1e-13;
/// A Lloyd run that has not found a better state for so many iterations walks in circles.
constexpr int patience = 4;
/// Faces that are gathered between two looks at whether to go on.
constexpr std::size_t polled_faces = 32768;

}  // namespace

VariationalLoop::VariationalLoop(const FlowInput& input)
    : mesh_(input.mesh),
      options_(input.options),
      control_(&input.control),
      passage_{&input.mesh, input.features, {}},
      policy_(method_policy(input.options, [this] { control_->check(); })),
      flood_(passage_) {
    if (input.features == nullptr) {
        components_ = mesh_.components;
        component_count_ = mesh_.component_count;
    } else {
        components_.assign(mesh_.face_count(), 0);
        component_count_ = partition::connected_parts(passage_, components_);
    }
    kept_.labels = components_;
    kept_.fits.resize(component_count_);
}

void VariationalLoop::start_from_seeds(std::size_t count) {
    const auto seeds = partition::random_seeds(mesh_, components_, component_count_, count, options_.seed);
    // Every face begins in the region of its component's first seed, so that the first flood finds all of them.
    std::vector<std::int32_t> first(component_count_, -1);
    state_ = {};
    state_.labels.resize(components_.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        auto& label = first[static_cast<std::size_t>(components_[seeds[i]])];
        if (label < 0) label = static_cast<std::int32_t>(i);
        state_.fits.emplace_back();
        state_.fits.back().proxy = quadric::plane_proxy(mesh_.centroid(seeds[i]), mesh_.normals[seeds[i]]);
        state_.stamps.push_back(next_stamp_++);
    }
    state_.seeds = seeds;
    state_.density.assign(components_.size(), 0);
    for (std::size_t f = 0; f < components_.size(); ++f) {
        state_.labels[f] = first[static_cast<std::size_t>(components_[f])];
    }
    list_faces();
    new_proxy_.assign(state_.regions(), 1);
    new_faces_.assign(state_.regions(), 1);
    // The flood takes known densities from the labels; there are none yet.
    runtime::parallel_for(components_.size(), 4096, [&](std::size_t f) {
        const auto r = static_cast<std::size_t>(state_.labels[f]);
        state_.density[f] = partition::error_density(mesh_, f, state_.fits[r].proxy, policy_.metric);
    });
    lloyd(1, FloodScope::all, false);
}

void VariationalLoop::start_from_labels(const partition::Labels& labels) {
    state_ = {};
    state_.labels = labels;
    const auto count =
        static_cast<std::size_t>(labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1);
    state_.fits.resize(count);
    state_.stamps.resize(count);
    state_.density.assign(labels.size(), 0);
    control_->check();
    list_faces();
    control_->check();
    for (const auto& faces : faces_) state_.seeds.push_back(faces.front());
    new_proxy_.assign(count, 1);
    new_faces_.assign(count, 1);
    fit_regions();
    update_seeds();
    add_up();

    // Components in which no region has its seed get a region of their own, or the flood would not reach them.
    std::vector<std::uint8_t> seeded(component_count_, 0);
    for (const std::uint32_t s : state_.seeds) seeded[static_cast<std::size_t>(components_[s])] = 1;
    for (std::size_t f = 0; f < components_.size(); ++f) {
        auto& has_seed = seeded[static_cast<std::size_t>(components_[f])];
        if (has_seed == 0) insert(static_cast<std::uint32_t>(f));
        has_seed = 1;
    }
    kept_ = state_;
}

void VariationalLoop::start_from_components() {
    start_from_labels(components_);
}

void VariationalLoop::restore(const LoopState& state) {
    state_ = state;
    kept_ = state;
    list_faces();
    new_proxy_.assign(state_.regions(), 0);
    new_faces_.assign(state_.regions(), 0);
}

int VariationalLoop::lloyd(int iterations, FloodScope scope, bool start_counts) {
    bool have_best = start_counts;
    if (start_counts) kept_ = state_;
    double previous = start_counts ? state_.energy : -1;
    int done = 0, fruitless = 0;
    while (done < iterations) {
        control_->check();
        if (scope == FloodScope::all) {
            std::vector<std::uint32_t> all(state_.regions());
            std::iota(all.begin(), all.end(), 0U);
            regroup(all);
        } else {
            regroup(affected_regions());
        }
        ++done;
        const bool changed = std::find(new_faces_.begin(), new_faces_.end(), 1) != new_faces_.end();
        if (changed) {
            fit_regions();
            update_seeds();
        }
        add_up();
        energies.push_back(state_.energy);
        control_->report(Phase::fine, progress, state_.regions(), state_.energy);
        if (!have_best || state_.energy < kept_.energy) {
            kept_ = state_;
            have_best = true;
            fruitless = 0;
        } else if (++fruitless >= patience) {
            break;
        }
        if (!changed || state_.energy <= zero_energy) break;
        if (previous >= 0 && std::abs(previous - state_.energy) <= options_.paper.convergence * previous) break;
        previous = state_.energy;
    }
    if (state_.energy != kept_.energy || state_.labels != kept_.labels) {
        restore(kept_);
    }
    std::fill(new_proxy_.begin(), new_proxy_.end(), std::uint8_t{0});
    return done;
}

std::vector<std::uint32_t> VariationalLoop::affected_regions() const {
    std::vector<std::uint8_t> affected = new_proxy_;
    for (std::size_t r = 0; r < state_.regions(); ++r) {
        if (new_proxy_[r] == 0) continue;
        for (const std::uint32_t f : faces_[r]) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t u = passage_.across(f, k);
                if (u != mesh::no_face)
                    affected[static_cast<std::size_t>(state_.labels[static_cast<std::size_t>(u)])] = 1;
            }
        }
    }
    std::vector<std::uint32_t> regions;
    for (std::size_t r = 0; r < affected.size(); ++r) {
        if (affected[r] != 0) regions.push_back(static_cast<std::uint32_t>(r));
    }
    return regions;
}

/// Different faces, ascending. Of many of them a look at all faces is less than a sort.
void VariationalLoop::sort_faces(std::vector<std::uint32_t>& faces) const {
    constexpr std::size_t many = 16;
    if (many * faces.size() < mesh_.face_count()) {
        std::sort(faces.begin(), faces.end());
        return;
    }
    std::vector<std::uint8_t> chosen(mesh_.face_count(), 0);
    for (const std::uint32_t f : faces) chosen[f] = 1;
    faces.clear();
    for (std::size_t f = 0; f < chosen.size(); ++f) {
        if (chosen[f] != 0) faces.push_back(static_cast<std::uint32_t>(f));
    }
}

void VariationalLoop::regroup(const std::vector<std::uint32_t>& regions) {
    std::vector<partition::SeededRegion> seeded;
    std::vector<std::uint32_t> faces;
    for (const std::uint32_t r : regions) {
        seeded.push_back({static_cast<std::int32_t>(r), state_.seeds[r], &state_.fits[r].proxy});
        faces.insert(faces.end(), faces_[r].begin(), faces_[r].end());
        faces_[r].clear();
    }
    control_->check();
    sort_faces(faces);
    control_->check();
    std::vector<std::int32_t> before(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) before[i] = state_.labels[faces[i]];
    flood_.run(seeded, faces, policy_.metric, state_.labels, state_.density, *control_);
    control_->check();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto old_region = static_cast<std::size_t>(before[i]);
        const auto new_region = static_cast<std::size_t>(state_.labels[faces[i]]);
        faces_[new_region].push_back(faces[i]);
        if (old_region == new_region) continue;
        new_faces_[old_region] = 1;
        new_faces_[new_region] = 1;
    }
    std::fill(new_proxy_.begin(), new_proxy_.end(), std::uint8_t{0});
}

void VariationalLoop::fit_regions() {
    std::vector<std::uint32_t> changed;
    for (std::size_t r = 0; r < state_.regions(); ++r) {
        if (new_faces_[r] != 0) changed.push_back(static_cast<std::uint32_t>(r));
    }
    // Large regions first: the last task to start should be a short one.
    std::sort(changed.begin(), changed.end(), [&](std::uint32_t a, std::uint32_t b) {
        return faces_[a].size() != faces_[b].size() ? faces_[a].size() > faces_[b].size() : a < b;
    });
    runtime::parallel_for(changed.size(), 1, [&](std::size_t i) {
        control_->check();
        const std::uint32_t r = changed[i];
        partition::GatheredRegion gathered;
        gathered.reserve(faces_[r].size());
        for (std::size_t begin = 0; begin < faces_[r].size(); begin += polled_faces) {
            control_->check();
            partition::append(mesh_, faces_[r].data() + begin, std::min(polled_faces, faces_[r].size() - begin),
                              gathered);
        }
        control_->check();
        state_.fits[r] = policy_.fit(gathered.soup());
        double area = 0;
        std::size_t polls = 0;
        for (const std::uint32_t f : faces_[r]) {
            control_->check_often(polls);
            area += mesh_.areas[f];
            state_.density[f] = partition::error_density(mesh_, f, state_.fits[r].proxy, policy_.metric);
        }
        areas_[r] = area;
    });
    for (const std::uint32_t r : changed) {
        state_.stamps[r] = next_stamp_++;
        new_proxy_[r] = 1;
    }
}

void VariationalLoop::update_seeds() {
    for (std::size_t r = 0; r < state_.regions(); ++r) {
        if (new_faces_[r] == 0) continue;
        state_.seeds[r] = partition::best_face(mesh_, faces_[r], state_.density);
        new_faces_[r] = 0;
    }
}

void VariationalLoop::list_faces() {
    faces_.assign(state_.regions(), {});
    for (std::size_t f = 0; f < state_.labels.size(); ++f) {
        faces_[static_cast<std::size_t>(state_.labels[f])].push_back(static_cast<std::uint32_t>(f));
    }
    areas_.assign(state_.regions(), 0);
    for (std::size_t r = 0; r < faces_.size(); ++r) {
        for (const std::uint32_t f : faces_[r]) areas_[r] += mesh_.areas[f];
    }
}

void VariationalLoop::add_up() {
    state_.energy = 0;
    for (const quadric::RegionFit& fit : state_.fits) state_.energy += fit.total;
}

partition::MergeableRegion VariationalLoop::mergeable(std::size_t region) const {
    return {faces_[region], state_.fits[region].total, state_.stamps[region]};
}

std::vector<partition::MergeCandidate> VariationalLoop::merge_candidates() {
    std::vector<partition::MergeableRegion> regions;
    for (std::size_t r = 0; r < state_.regions(); ++r) regions.push_back(mergeable(r));
    const auto pairs = partition::region_pairs(passage_, state_.labels, *control_);
    return candidates_.evaluate(mesh_, pairs, regions, policy_.fit, *control_);
}

partition::MergeCandidate VariationalLoop::merge_candidate(std::uint32_t a, std::uint32_t b) const {
    const auto fit = partition::fit_union(mesh_, mergeable(a), mergeable(b), policy_.fit, *control_);
    return {{std::min(a, b), std::max(a, b)}, fit.total - state_.fits[a].total - state_.fits[b].total, fit.valid};
}

void VariationalLoop::merge(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    for (const std::uint32_t f : faces_[b]) state_.labels[f] = static_cast<std::int32_t>(a);
    std::vector<std::uint32_t> both(faces_[a].size() + faces_[b].size());
    std::merge(faces_[a].begin(), faces_[a].end(), faces_[b].begin(), faces_[b].end(), both.begin());
    faces_[a] = std::move(both);
    new_faces_[a] = 1;
    const std::size_t last = state_.regions() - 1;
    if (b != last) {
        for (const std::uint32_t f : faces_[last]) state_.labels[f] = static_cast<std::int32_t>(b);
        faces_[b] = std::move(faces_[last]);
        areas_[b] = areas_[last];
        state_.fits[b] = state_.fits[last];
        state_.seeds[b] = state_.seeds[last];
        state_.stamps[b] = state_.stamps[last];
        new_proxy_[b] = new_proxy_[last];
        new_faces_[b] = new_faces_[last];
    }
    faces_.pop_back();
    areas_.pop_back();
    state_.fits.pop_back();
    state_.seeds.pop_back();
    state_.stamps.pop_back();
    new_proxy_.pop_back();
    new_faces_.pop_back();
    fit_regions();
    update_seeds();
    add_up();
}

bool VariationalLoop::all_valid() const noexcept {
    return std::all_of(state_.fits.begin(), state_.fits.end(), [](const auto& fit) { return fit.valid; });
}

Energy VariationalLoop::energy_terms() const {
    Energy energy;
    for (std::size_t f = 0; f < state_.labels.size(); ++f) {
        const quadric::Proxy& proxy = state_.fits[static_cast<std::size_t>(state_.labels[f])].proxy;
        const quadric::TriangleEnergy e = partition::face_energy(mesh_, f, proxy, policy_.metric.normalised);
        energy.distance += e.distance;
        energy.normal += e.normal;
    }
    energy.total = energy.distance + options_.weight * energy.normal;
    return energy;
}

std::vector<std::uint32_t> VariationalLoop::regions_to_split() const {
    std::vector<partition::InsertionCandidate> regions;
    for (std::size_t r = 0; r < state_.regions(); ++r) {
        regions.push_back({state_.fits[r].total, areas_[r], state_.fits[r].valid, faces_[r].size()});
    }
    return partition::farthest_regions(regions);
}

bool VariationalLoop::insert(std::uint32_t face, bool restart) {
    const auto r = static_cast<std::size_t>(state_.labels[face]);
    if (faces_[r].size() < 2) return false;
    if (state_.seeds[r] == face) state_.seeds[r] = partition::best_face(mesh_, faces_[r], state_.density, face);
    quadric::RegionFit plane;
    plane.proxy = quadric::plane_proxy(mesh_.centroid(face), mesh_.normals[face]);
    if (restart) {
        const auto measure = [&](const quadric::Proxy& proxy) {
            for (const std::uint32_t f : faces_[r]) {
                state_.density[f] = partition::error_density(mesh_, f, proxy, policy_.metric);
            }
        };
        measure(plane.proxy);
        if (const auto other = partition::worst_face(mesh_, faces_[r], state_.density, face)) {
            state_.seeds[r] = *other;
            state_.fits[r].proxy = quadric::plane_proxy(mesh_.centroid(*other), mesh_.normals[*other]);
        }
        measure(state_.fits[r].proxy);
        new_faces_[r] = 1;
    }
    state_.fits.push_back(plane);
    state_.seeds.push_back(face);
    state_.stamps.push_back(next_stamp_++);
    faces_.emplace_back();
    areas_.push_back(0);
    new_proxy_[r] = 1;
    new_proxy_.push_back(1);
    new_faces_.push_back(1);
    return true;
}

std::optional<std::uint32_t> VariationalLoop::face_to_split(std::uint32_t region, int rounds) const {
    const auto& faces = faces_[region];
    if (rounds == 0) return partition::worst_face(mesh_, faces, state_.density, state_.seeds[region]);
    const auto smooth = partition::smoothed_density(passage_, faces, state_.labels, state_.density, rounds);
    return partition::worst_face(mesh_, faces, smooth, state_.seeds[region]);
}

}  // namespace quadseg::flow
