#include "tools/cli/picture.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace quadseg::cli {
namespace {

constexpr std::size_t legend_width = 380;
constexpr Rgb paper{255, 255, 255};
constexpr Rgb ink{40, 44, 52};
constexpr Rgb plain_color{200, 205, 214};

void draw_type_legend(Image& image, std::size_t left, std::span<const SurfaceType> types) {
    std::array<std::size_t, surface_type_count> count{};
    for (const SurfaceType type : types) ++count[static_cast<std::size_t>(type)];
    std::size_t y = 40;
    for (std::size_t t = 0; t < count.size(); ++t) {
        if (count[t] == 0) continue;
        const auto type = static_cast<SurfaceType>(t);
        fill_rectangle(image, left, y, 26, 26, ink);
        fill_rectangle(image, left + 2, y + 2, 22, 22, type_color(type));
        std::string text = std::to_string(count[t]) + " " + to_string(type);
        std::replace(text.begin(), text.end(), '_', ' ');
        draw_text(image, left + 38, y + 6, text, ink, text.size() > 28 ? 1 : 2);
        y += 38;
    }
}

void draw_error_scale(Image& image, std::size_t left, double largest) {
    constexpr std::size_t top = 60, length = 320;
    for (std::size_t y = 0; y < length; ++y) {
        const double share = 1 - (static_cast<double>(y) + 0.5) / static_cast<double>(length);
        fill_rectangle(image, left, top + y, 30, 1, error_color(share));
    }
    for (const int quarter : {0, 1, 2, 3, 4}) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g", largest * quarter / 4);
        const std::size_t y = top + length - length * static_cast<std::size_t>(quarter) / 4;
        fill_rectangle(image, left + 30, y, 8, 1, ink);
        draw_text(image, left + 46, y - 6, text, ink, 2);
    }
}

}  // namespace

void write_picture(const std::string& path, const MeshView& mesh, const PictureContent& content) {
    std::vector<Rgb> colors;
    if (!content.types.empty()) {
        for (const SurfaceType type : content.types) colors.push_back(type_color(type));
    } else if (!content.labels.empty()) {
        const std::int32_t last = *std::max_element(content.labels.begin(), content.labels.end());
        for (std::int32_t r = 0; r <= last; ++r) colors.push_back(region_color(r));
    } else {
        colors.push_back(plain_color);
    }
    std::vector<double> shares;
    for (const double error : content.errors) {
        shares.push_back(content.largest_error > 0 ? error / content.largest_error : 0);
    }
    const bool legend = !content.types.empty() || !content.errors.empty();
    Image image(content.width + (legend ? legend_width : 0), content.height, paper);
    Scene scene{mesh, content.labels, colors, shares, content.edges};
    scene.edge_color = content.edge_color;
    scene.edge_width = content.edge_width;
    scene.up = content.up;
    draw_scene(image, content.width, content.height, scene);
    if (!content.errors.empty()) {
        draw_error_scale(image, content.width, content.largest_error);
    } else if (!content.types.empty()) {
        draw_type_legend(image, content.width, content.types);
    }
    write_png(path, image);
}

void write_region_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation) {
    PictureContent content;
    content.labels = segmentation.labels;
    write_picture(path, mesh.view(), content);
}

void write_type_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation) {
    std::vector<SurfaceType> types;
    for (const Region& region : segmentation.regions) types.push_back(region.surface.type);
    PictureContent content;
    content.labels = segmentation.labels;
    content.types = types;
    write_picture(path, mesh.view(), content);
}

}  // namespace quadseg::cli
