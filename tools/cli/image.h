// An image in memory, text on it, and PNG.
#pragma once

#include "tools/cli/colors.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace quadseg::cli {

struct Image {
    std::size_t width = 0, height = 0;
    std::vector<Rgb> pixels;

    Image(std::size_t w, std::size_t h, Rgb background) : width(w), height(h), pixels(w * h, background) {}
    Rgb& at(std::size_t x, std::size_t y) { return pixels[y * width + x]; }
};

void fill_rectangle(Image& image, std::size_t x, std::size_t y, std::size_t width, std::size_t height, Rgb color);
/// Small letters, digits, minus, point and spaces, each letter 6·scale wide and 9·scale high with its descender;
/// clipped.
void draw_text(Image& image, std::size_t x, std::size_t y, std::string_view text, Rgb color, std::size_t scale);
/// Throws Error file_write.
void write_png(const std::string& path, const Image& image);

}  // namespace quadseg::cli
