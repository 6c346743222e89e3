#include "tools/cli/colors.h"

#include <algorithm>
#include <cmath>

namespace quadseg::cli {
namespace {

/// Hue, saturation and value in 0 … 1.
Rgb from_hsv(double hue, double saturation, double value) {
    const auto channel = [&](double n) {
        const double k = std::fmod(n + hue * 6, 6);
        const double c = value - value * saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
        return static_cast<std::uint8_t>(std::lround(255 * c));
    };
    return {channel(5), channel(3), channel(1)};
}

}  // namespace

Rgb region_color(std::int32_t region) {
    if (region < 0) return unlabelled_color;
    // Multiples of the golden ratio never come close to each other.
    const double golden = 0.6180339887498949;
    const double hue = std::fmod(0.58 + region * golden, 1.0);
    constexpr std::array saturation{0.42, 0.56, 0.3, 0.48};
    constexpr std::array value{0.96, 0.9, 0.93, 0.84};
    const auto k = static_cast<std::size_t>(region) % 4;
    return from_hsv(hue, saturation[k], value[k]);
}

Rgb type_color(SurfaceType type) {
    constexpr std::array<Rgb, surface_type_count> legend{{
        {176, 196, 222},  // plane
        {240, 128, 96},   // sphere
        {86, 152, 224},   // cylinder
        {246, 190, 70},   // cone
        {120, 190, 110},  // torus
        {214, 94, 130},   // ellipsoid
        {70, 180, 190},   // elliptic cylinder
        {222, 150, 40},   // elliptic cone
        {170, 120, 210},  // elliptic paraboloid
        {230, 110, 200},  // hyperbolic paraboloid
        {140, 110, 90},   // hyperboloid of one sheet
        {190, 150, 120},  // hyperboloid of two sheets
        {90, 200, 150},   // parabolic cylinder
        {60, 140, 120},   // hyperbolic cylinder
        {150, 150, 90},   // quadric
        {190, 220, 120},  // blend
        {130, 130, 140},  // freeform
    }};
    return legend[static_cast<std::size_t>(type)];
}

Rgb error_color(double share) {
    constexpr std::array<std::array<double, 3>, 5> stops{
        {{49, 84, 178}, {70, 170, 200}, {110, 190, 100}, {245, 205, 70}, {205, 45, 40}}};
    // What is no number is an error as well.
    const double place = share >= 0 && share < 1 ? share * static_cast<double>(stops.size() - 1) : stops.size() - 1.0;
    const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double t = place - static_cast<double>(below);
    Rgb color{};
    for (std::size_t c = 0; c < 3; ++c) {
        color[c] = static_cast<std::uint8_t>(std::lround((1 - t) * stops[below][c] + t * stops[below + 1][c]));
    }
    return color;
}

std::vector<std::uint8_t> face_colors(std::span<const std::int32_t> labels, std::span<const Rgb> color_of_region) {
    std::vector<std::uint8_t> rgb(3 * labels.size());
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const auto label = static_cast<std::size_t>(labels[f]);
        const Rgb& color = labels[f] >= 0 && label < color_of_region.size() ? color_of_region[label] : unlabelled_color;
        for (std::size_t k = 0; k < 3; ++k) rgb[3 * f + k] = color[k];
    }
    return rgb;
}

}  // namespace quadseg::cli
