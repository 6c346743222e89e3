#include "quadric/energy_batch.h"

#include <algorithm>

namespace quadseg::quadric {

std::size_t EnergyBatch::add(const Proxy& proxy, const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& n,
                             double area) noexcept {
    const std::size_t pair = size_++;
    if (proxy.planar() || !(area > 0)) {
        hybrid_[pair] = triangle_energy(proxy, v0, v1, v2, n, area).hybrid(weight_);
        return pair;
    }
    pair_of_[quadrics_] = static_cast<std::uint8_t>(pair);
    Slot& slot = slots_[quadrics_ / lanes];
    const std::size_t lane = quadrics_ % lanes;
    ++quadrics_;
    const std::array<const Vec3*, 3> corner = {&v0, &v1, &v2};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 u = *corner[k] - proxy.origin;
        slot.face.corners[3 * k][lane] = u.x;
        slot.face.corners[3 * k + 1][lane] = u.y;
        slot.face.corners[3 * k + 2][lane] = u.z;
    }
    slot.face.normal[0][lane] = n.x;
    slot.face.normal[1][lane] = n.y;
    slot.face.normal[2][lane] = n.z;
    slot.face.area[lane] = area;
    for (std::size_t i = 0; i < 10; ++i) slot.c[i][lane] = proxy.c[i];
    slot.floor[lane] = proxy.gradient_floor;
    return pair;
}

void EnergyBatch::evaluate() noexcept {
    for (std::size_t first = 0; first < quadrics_; first += lanes) {
        Slot& slot = slots_[first / lanes];
        const std::size_t used = std::min(lanes, quadrics_ - first);
        for (std::size_t l = used; l < lanes; ++l) {  // what is left over from before may not be finite
            slot.face.area[l] = 0;
            slot.floor[l] = 1;
            for (Pack& c : slot.c) c[l] = 0;
            for (Pack& x : slot.face.corners) x[l] = 0;
        }
        for (std::size_t part = 0; part < parts; ++part) {
            constexpr std::size_t size = lanes / parts;
            PartEnergy energy;
            part_energy(Parts(&slot.c[0], part), FacePart(slot.face, part), part_of(slot.floor, part), energy);
            for (std::size_t l = 0; l < size && part * size + l < used; ++l) {
                const double distance = std::max(0.0, energy.distance[l] * (1.0 / 180));
                hybrid_[pair_of_[first + part * size + l]] = distance + weight_ * (energy.normal[l] * (1.0 / 12));
            }
        }
    }
}

}  // namespace quadseg::quadric
