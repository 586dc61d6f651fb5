// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/event_image.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>

namespace pursuit::ctl {
namespace {

/// Palette: 0 nothing, 1 … levels ON, then as many OFF. More events: more opaque.
constexpr int levels = 4;
constexpr std::array<png_byte, levels> opacity = {130, 180, 220, 255};
constexpr png_color on_colour = {62, 116, 178};
constexpr png_color off_colour = {176, 124, 84};

/// libpng reports by longjmp, past which no destructor runs: this function has no object that
/// needs one. Returns libpng's message, or null.
struct Sink {
    std::vector<std::uint8_t>* bytes;
    const char* error;
};

void write_bytes(png_structp png, png_bytep data, png_size_t size) {
    auto* bytes = static_cast<Sink*>(png_get_io_ptr(png))->bytes;
    bytes->insert(bytes->end(), data, data + size);
}

void note_error(png_structp png, png_const_charp message) {
    static_cast<Sink*>(png_get_error_ptr(png))->error = message;
    std::longjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf)), 1);
}

bool encode(const std::uint8_t* pixels, Geometry geometry, Sink& sink) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, note_error, nullptr);
    if (png == nullptr) return false;
    png_infop info = png_create_info_struct(png);
    if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &sink, write_bytes, nullptr);
    png_set_IHDR(png, info, geometry.width, geometry.height, 4, PNG_COLOR_TYPE_PALETTE,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    std::array<png_color, 1 + 2 * levels> palette{};
    std::array<png_byte, 1 + 2 * levels> alpha{};
    for (std::size_t i = 0; i < levels; ++i) {
        palette[1 + i] = on_colour;
        palette[1 + levels + i] = off_colour;
        alpha[1 + i] = alpha[1 + levels + i] = opacity[i];
    }
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    png_set_tRNS(png, info, alpha.data(), static_cast<int>(alpha.size()), nullptr);
    png_write_info(png, info);
    png_set_packing(png);
    for (std::size_t y = 0; y < geometry.height; ++y) {
        png_write_row(png, pixels + y * geometry.width);
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

}  // namespace

Result<std::vector<std::uint8_t>> event_png(const std::vector<Event>& events, Geometry geometry) {
    if (geometry.width == 0 || geometry.height == 0) return fail("a picture without pixels");
    const std::size_t pixels = std::size_t{geometry.width} * geometry.height;
    std::vector<int> balance(pixels, 0);
    std::vector<int> count(pixels, 0);
    for (const auto& event : events) {
        if (event.x >= geometry.width || event.y >= geometry.height) continue;
        const std::size_t at = std::size_t{event.y} * geometry.width + event.x;
        balance[at] += event.polarity != 0 ? 1 : -1;
        ++count[at];
    }
    std::vector<std::uint8_t> image(pixels, 0);
    for (std::size_t i = 0; i < pixels; ++i) {
        if (count[i] == 0) continue;
        const int level = std::min(count[i], levels);
        image[i] = static_cast<std::uint8_t>(balance[i] >= 0 ? level : levels + level);
    }
    std::vector<std::uint8_t> bytes;
    Sink sink{&bytes, nullptr};
    if (!encode(image.data(), geometry, sink)) {
        return fail(std::string("a picture cannot be written: ") +
                    (sink.error != nullptr ? sink.error : "libpng"));
    }
    return bytes;
}

}  // namespace pursuit::ctl
