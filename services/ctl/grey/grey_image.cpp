// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/grey/grey_image.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pursuit::ctl {
namespace {

constexpr double dark_share = 0.02;  // of the pixels, at either end of the scale
constexpr double levels_count = 254;

}  // namespace

GreyImage::GreyImage(Geometry geometry)
    : geometry_(geometry),
      begun_us_(std::size_t{geometry.width} * geometry.height, -1),
      integration_us_(begun_us_.size()) {}

void GreyImage::take(std::span<const Event> exposures) {
    for (const auto& crossing : exposures) {
        if (crossing.x >= geometry_.width || crossing.y >= geometry_.height) continue;
        const auto pixel = std::size_t{crossing.y} * geometry_.width + crossing.x;
        if (crossing.polarity == 0) {
            begun_us_[pixel] = crossing.t_us;
        } else if (begun_us_[pixel] >= 0) {
            const auto took_us = crossing.t_us - std::exchange(begun_us_[pixel], -1);
            // Both within one microsecond: as bright as can be told.
            integration_us_[pixel] = static_cast<std::uint32_t>(
                std::clamp<std::int64_t>(took_us, 1, std::numeric_limits<std::uint32_t>::max()));
        }
    }
}

std::size_t GreyImage::measured_pixels() const {
    return integration_us_.size() -
           static_cast<std::size_t>(std::count(integration_us_.begin(), integration_us_.end(), 0U));
}

std::vector<std::uint8_t> GreyImage::levels() const {
    std::vector<std::uint8_t> levels(integration_us_.size());
    std::vector<std::uint32_t> sorted;
    std::copy_if(integration_us_.begin(), integration_us_.end(), std::back_inserter(sorted),
                 [](auto us) { return us > 0; });
    if (sorted.empty()) return levels;
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
        const auto index = std::lround(share * static_cast<double>(sorted.size() - 1));
        return std::log(static_cast<double>(sorted[static_cast<std::size_t>(index)]));
    };
    const double bright = at(dark_share);
    const double dark = at(1 - dark_share);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (integration_us_[i] == 0) continue;
        const double above = dark - std::log(static_cast<double>(integration_us_[i]));
        const double share = dark > bright ? std::clamp(above / (dark - bright), 0.0, 1.0) : 1.0;
        levels[i] = static_cast<std::uint8_t>(1 + std::lround(levels_count * share));
    }
    return levels;
}

Result<std::vector<std::uint8_t>> grey_png(const GreyImage& image) {
    const auto levels = image.levels();
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = image.geometry().width;
    png.height = image.geometry().height;
    png.format = PNG_FORMAT_GRAY;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::uint8_t> bytes(size);
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, levels.data(), 0, nullptr) == 0) {
        return fail(std::string("the PNG cannot be made: ") + png.message);
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace pursuit::ctl
