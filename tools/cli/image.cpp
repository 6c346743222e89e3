#include "tools/cli/image.h"

#include <quadseg/error.h>
#include <quadseg/io.h>

#include "tools/cli/font.h"

#include <algorithm>
#include <png.h>

namespace quadseg::cli {

void fill_rectangle(Image& image, std::size_t x, std::size_t y, std::size_t width, std::size_t height, Rgb color) {
    for (std::size_t j = y; j < std::min(y + height, image.height); ++j) {
        for (std::size_t i = x; i < std::min(x + width, image.width); ++i) image.at(i, j) = color;
    }
}

void draw_text(Image& image, std::size_t x, std::size_t y, std::string_view text, Rgb color, std::size_t scale) {
    for (const char letter : text) {
        const Glyph* glyph = nullptr;
        if (letter >= '0' && letter <= '9') glyph = &font[static_cast<std::size_t>(letter - '0')];
        if (letter >= 'a' && letter <= 'z') glyph = &font[static_cast<std::size_t>(letter - 'a') + 10];
        if (letter == '-') fill_rectangle(image, x + scale, y + 3 * scale, 3 * scale, scale, color);
        if (letter == '.') fill_rectangle(image, x + 2 * scale, y + 6 * scale, scale, scale, color);
        for (std::size_t row = 0; glyph != nullptr && row < glyph->size(); ++row) {
            for (std::size_t column = 0; column < 5; ++column) {
                if (((*glyph)[row] >> (4 - column) & 1U) == 0) continue;
                fill_rectangle(image, x + column * scale, y + row * scale, scale, scale, color);
            }
        }
        x += 6 * scale;
    }
}

void write_png(const std::string& path, const Image& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr) == 0) {
        throw Error(ErrorCode::file_write, path + ": " + header.message);
    }
    bytes.resize(size);
    write_text(path, bytes);
}

}  // namespace quadseg::cli
