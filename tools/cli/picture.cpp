#include "tools/cli/picture.h"

#include "tools/cli/rasterizer.h"

#include <algorithm>
#include <array>

namespace quadseg::cli {
namespace {

constexpr std::size_t picture_width = 1000;
constexpr std::size_t picture_height = 750;
constexpr std::size_t legend_width = 330;
constexpr Rgb paper{255, 255, 255};
constexpr Rgb ink{40, 44, 52};

void draw_legend(Image& image, const Segmentation& segmentation) {
    std::array<std::size_t, surface_type_count> count{};
    for (const Region& region : segmentation.regions) ++count[static_cast<std::size_t>(region.surface.type)];
    std::size_t y = 40;
    for (std::size_t t = 0; t < count.size(); ++t) {
        if (count[t] == 0) continue;
        const auto type = static_cast<SurfaceType>(t);
        fill_rectangle(image, picture_width, y, 26, 26, ink);
        fill_rectangle(image, picture_width + 2, y + 2, 22, 22, type_color(type));
        std::string text = std::to_string(count[t]) + " " + to_string(type);
        std::replace(text.begin(), text.end(), '_', ' ');
        draw_text(image, picture_width + 38, y + 6, text, ink, text.size() > 24 ? 1 : 2);
        y += 38;
    }
}

}  // namespace

void write_region_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation) {
    std::vector<Rgb> colors;
    for (const Region& region : segmentation.regions) colors.push_back(region_color(region.id));
    Image image(picture_width, picture_height, paper);
    draw_scene(image, picture_width, picture_height, {mesh.view(), segmentation.labels, colors});
    write_png(path, image);
}

void write_type_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation) {
    std::vector<Rgb> colors;
    for (const Region& region : segmentation.regions) colors.push_back(type_color(region.surface.type));
    Image image(picture_width + legend_width, picture_height, paper);
    draw_scene(image, picture_width, picture_height, {mesh.view(), segmentation.labels, colors});
    draw_legend(image, segmentation);
    write_png(path, image);
}

}  // namespace quadseg::cli
