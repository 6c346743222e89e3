#include "quadric/moment_accumulator.h"

#include "quadric/triangle_moments.h"

namespace quadseg::quadric {

void MomentAccumulator::flush() noexcept {
    for (std::size_t l = filled_; l < lanes; ++l) area_[l] = 0;  // what was there counts no more
    for (std::size_t part = 0; part < parts; ++part) {
        Part m[35];
        triangle_moments(Parts(&corners_[0], part), part_of(area_, part), m);
        sum_.add(part, m, Parts(&normal_[0], part));
    }
    areas_.add(area_, &normal_[0]);
    filled_ = 0;
}

Moments MomentAccumulator::moments() noexcept {
    if (filled_ > 0) flush();
    Moments m;
    sum_.sum(m);
    areas_.sum(m);
    return m;
}

}  // namespace quadseg::quadric
