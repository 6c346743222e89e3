#include "partition/face_choice.h"

#include <algorithm>

namespace quadseg::partition {
namespace {

/// Energy densities below this differ by rounding only.
constexpr double density_floor = 1e-15;
/// Faces whose energies are found together: each has at most four.
constexpr std::size_t group_faces = quadric::EnergyBatch::capacity / 4;

}  // namespace

FaceChooser::Candidates FaceChooser::candidates(std::size_t f, quadric::EnergyBatch& batch) const noexcept {
    Candidates c;
    const std::int32_t own = labels_[f];
    std::array<std::int32_t, 3> across{};
    bool at_border = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t g = passage_.across(f, k);
        across[k] = g < 0 ? -1 : labels_[static_cast<std::size_t>(g)];
        const bool known =
            across[k] < 0 || across[k] == own || std::find(across.data(), &across[k], across[k]) != &across[k];
        c.other[k] = known ? -1 : across[k];
        at_border = at_border || !known;
    }
    if (!at_border) return c;
    c.own = own;
    const Vec3 v0 = mesh_.corner(f, 0), v1 = mesh_.corner(f, 1), v2 = mesh_.corner(f, 2);
    const auto add = [&](std::int32_t label) {
        return batch.add(fits_[static_cast<std::size_t>(label)].proxy, v0, v1, v2, mesh_.normals[f], mesh_.areas[f]);
    };
    c.own_energy = add(own);
    for (std::size_t k = 0; k < 3; ++k) {
        if (c.other[k] >= 0) c.energy[k] = add(c.other[k]);
    }
    if (options_.border.length > 0) add_prices(f, across, c);
    return c;
}

void FaceChooser::add_prices(std::size_t f, const std::array<std::int32_t, 3>& across, Candidates& c) const noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
        if (across[k] < 0) continue;
        const auto g = static_cast<std::size_t>(passage_.across(f, k));
        const auto price = [&](std::int32_t label) {
            return options_.border.of_edge(mesh_, f, k, g, fits_[static_cast<std::size_t>(label)].proxy,
                                           fits_[static_cast<std::size_t>(across[k])].proxy);
        };
        if (across[k] != c.own) c.own_price += price(c.own);
        for (std::size_t j = 0; j < 3; ++j) {
            if (c.other[j] >= 0 && c.other[j] != across[k]) c.price[j] += price(c.other[j]);
        }
    }
}

FaceChoice FaceChooser::best(std::size_t f, const Candidates& c, const quadric::EnergyBatch& batch) const noexcept {
    const double own_energy = batch.hybrid(c.own_energy) + c.own_price;
    FaceChoice best{c.own, 0};
    double lowest = own_energy * (1 - options_.margin) - density_floor * mesh_.areas[f];
    for (std::size_t k = 0; k < 3; ++k) {
        if (c.other[k] < 0) continue;
        const double e = batch.hybrid(c.energy[k]) + c.price[k];
        if (e < lowest || (e == lowest && best.label != c.own && c.other[k] < best.label)) {
            lowest = e;
            best = {c.other[k], own_energy - e};
        }
    }
    return best;
}

void FaceChooser::decide(std::span<const std::uint32_t> faces, FaceChoice* out) const noexcept {
    quadric::EnergyBatch batch(options_.weight);
    std::array<Candidates, group_faces> group;
    for (std::size_t begin = 0; begin < faces.size(); begin += group_faces) {
        const std::size_t size = std::min(group_faces, faces.size() - begin);
        batch.clear();
        for (std::size_t i = 0; i < size; ++i) group[i] = candidates(faces[begin + i], batch);
        batch.evaluate();
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t f = faces[begin + i];
            out[begin + i] = group[i].own < 0 ? FaceChoice{labels_[f], 0} : best(f, group[i], batch);
        }
    }
}

}  // namespace quadseg::partition
