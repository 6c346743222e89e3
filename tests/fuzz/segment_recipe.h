// Bytes that a fuzzer invents, read as a recipe: a shape, what is done to it, and what is asked of it.
#pragma once

#include <quadseg/options.h>

#include "tests/hostile/nasty_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace quadseg::fuzz {

/// Bytes one after the other; zeros when they are used up.
class Bytes {
  public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    bool empty() const { return at_ >= size_; }
    std::uint32_t byte() { return at_ < size_ ? data_[at_++] : 0U; }
    std::uint32_t below(std::uint32_t n) { return n < 2 ? 0 : (n <= 256 ? byte() : byte() << 8U | byte()) % n; }
    std::uint32_t between(std::uint32_t low, std::uint32_t high) { return low + below(high - low + 1); }
    /// −1 … 1, multiples of 1/128: what meets, meets exactly.
    double coordinate() { return (static_cast<double>(byte()) - 128) / 128; }

  private:
    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

inline test::Shape raw_shape(Bytes& in) {
    test::Shape s;
    const std::uint32_t vertices = in.between(1, 60), faces = in.between(1, 100);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const double x = in.coordinate(), y = in.coordinate();
        s.vertex(x, y, in.coordinate());
    }
    for (std::uint32_t f = 0; f < faces; ++f) {
        const std::uint32_t a = in.below(vertices), b = in.below(vertices);
        s.face(a, b, in.below(vertices));
    }
    return s;
}

inline test::Shape base_shape(Bytes& in) {
    switch (in.below(12)) {
        case 0:
            return test::box(in.between(1, 6));
        case 1:
            return test::can(in.between(3, 24), in.between(1, 6));
        case 2:
            return test::frustum(in.between(3, 24), in.between(1, 5));
        case 3:
            return test::ball(in.between(3, 20), in.between(2, 12));
        case 4:
            return test::grid(in.between(1, 12), in.between(1, 12));
        case 5:
            return test::bumpy_grid(in.between(1, 12));
        case 6:
            return test::band(in.between(3, 40), in.below(2) == 1);
        case 7:
            return test::fan(in.between(3, 200), in.coordinate());
        case 8:
            return test::book(in.between(1, 12));
        case 9:
            return test::needles(in.between(1, 60));
        case 10:
            return test::l_block(in.between(1, 4));
        default:
            return raw_shape(in);
    }
}

inline void jitter(test::Shape& s, Bytes& in) {
    const double size = std::pow(10, -static_cast<double>(in.below(13)));
    test::Random random{in.byte()};
    for (double& x : s.positions) x += size * (static_cast<double>(random.next() >> 11) * 0x1p-53 - 0.5);
}

/// Turns about z.
inline void turn(test::Shape& s, Bytes& in) {
    const double angle = in.coordinate() * 3, c = std::cos(angle), d = std::sin(angle);
    for (std::size_t v = 0; v + 2 < s.positions.size(); v += 3) {
        const double x = s.positions[v], y = s.positions[v + 1];
        s.positions[v] = c * x - d * y;
        s.positions[v + 1] = d * x + c * y;
    }
}

inline void change(test::Shape& s, Bytes& in) {
    const auto faces = static_cast<std::uint32_t>(s.faces());
    const auto vertices = static_cast<std::uint32_t>(s.positions.size() / 3);
    if (faces == 0 || faces > 1500 || vertices == 0) return;
    switch (in.below(14)) {
        case 0:
            jitter(s, in);
            break;
        case 1: {  // holes
            const std::size_t from = 3 * std::size_t{in.below(faces)};
            const std::size_t to = std::min(s.triangles.size(), from + 3 * std::size_t{in.between(1, 20)});
            s.triangles.erase(s.triangles.begin() + static_cast<std::ptrdiff_t>(from),
                              s.triangles.begin() + static_cast<std::ptrdiff_t>(to));
            break;
        }
        case 2:
            s = test::flipped_half(s);
            break;
        case 3:
            s = test::with_duplicates(s);
            break;
        case 4:
            s = test::with_degenerate(s);
            break;
        case 5:
            s = test::soup(s);
            break;
        case 6:
            s = test::joined(s, base_shape(in));
            break;
        case 7:  // one vertex goes elsewhere
            s.positions[3 * std::size_t{in.below(vertices)} + in.below(3)] =
                in.coordinate() * std::pow(10, static_cast<double>(in.below(24)) - 12);
            break;
        case 8:  // two vertices become one
            std::replace(s.triangles.begin(), s.triangles.end(), in.below(vertices), in.below(vertices));
            break;
        case 9:
            s = test::scaled(s, std::pow(10, static_cast<double>(in.below(61)) - 30));
            break;
        case 10:
            s = test::scaled(s, 1, in.coordinate() * std::pow(10, static_cast<double>(in.below(12))));
            break;
        case 11:
            turn(s, in);
            break;
        case 12:  // as text with few digits would have it
            for (double& x : s.positions) x = std::round(x * 1e4) / 1e4;
            break;
        default:  // as float32
            for (double& x : s.positions) x = static_cast<double>(static_cast<float>(x));
            break;
    }
}

inline test::Shape shape_of(Bytes& in) {
    test::Shape s = base_shape(in);
    const std::uint32_t changes = in.below(5);
    for (std::uint32_t i = 0; i < changes; ++i) change(s, in);
    return s;
}

inline Options options_of(Bytes& in) {
    Options o;
    const std::uint32_t kind = in.below(8);
    if (kind >= 5) o.preset = Preset::paper;
    if (kind == 1 || kind >= 6) o.regions = in.between(1, 40);
    if (kind == 2) o.tolerance = std::pow(10, -static_cast<double>(in.between(1, 6)));
    if (in.below(3) == 1) o.feature_angle = in.between(1, 179);
    o.smooth = in.below(4) == 1;
    o.project = in.below(4) == 1;
    o.project_joint = in.below(2) == 1;
    if (in.below(6) == 1) o.detail = std::pow(2, in.coordinate() * 4);
    if (o.preset == Preset::paper) {
        constexpr std::array methods{Method::quadric,          Method::quadric,     Method::vsa_l21,
                                     Method::vsa_l2,           Method::hybrid,      Method::quadric_l2,
                                     Method::quadric_gradient, Method::hierarchical};
        o.method = methods[in.below(methods.size())];
        o.paper.initial_regions = o.regions > 0 ? in.below(3) : 1;
        o.paper.lloyd_iterations = static_cast<int>(in.between(1, 8));
        o.paper.maximum_regions = 60;
        if (in.below(4) == 1) o.coarse = in.between(4, 300);
        o.seed = in.byte();
    }
    return o;
}

}  // namespace quadseg::fuzz
