// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/pixel_mask.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "filters.pb.h"
#include "services/common/text_format.hpp"

namespace pursuit::sensor {
namespace {

class PixelMask final : public Filter {
 public:
    PixelMask(std::vector<bool> masked, Geometry input) : input_(input), passes_(masked.size()) {
        std::transform(masked.begin(), masked.end(), passes_.begin(), std::logical_not());
    }

    std::size_t apply(std::span<Event> events) override {
        return keep_if(events, [this](const Event& event) {
            return passes_[std::size_t{event.y} * input_.width + event.x] != 0;
        });
    }

    Geometry geometry() const override { return input_; }
    bool by_pixel_alone() const override { return true; }

 private:
    Geometry input_;
    std::vector<std::uint8_t> passes_;  // by y·width + x; one byte is quicker to look up than a bit
};

}  // namespace

Result<std::unique_ptr<Filter>> make_pixel_mask(const FilterArguments& arguments, Geometry input) {
    disk::PixelMask file;
    if (auto ok = read_text_file(arguments.file(), file, nullptr, Quoting::nothing); !ok) {
        return tl::unexpected(ok.error());
    }
    if (file.width() != input.width || file.height() != input.height) {
        return fail(arguments.file() + ": is for " + std::to_string(file.width()) + "x" +
                    std::to_string(file.height()) + " pixels, the events are of " +
                    std::to_string(input.width) + "x" + std::to_string(input.height));
    }
    std::vector<bool> masked(std::size_t{input.width} * input.height);
    const auto mask = [&](std::uint64_t x, std::uint64_t y, std::uint64_t width,
                          std::uint64_t height) {
        if (x + width > input.width || y + height > input.height) return false;
        for (auto row = y; row < y + height; ++row) {
            for (auto column = x; column < x + width; ++column) {
                masked[row * input.width + column] = true;
            }
        }
        return true;
    };
    const auto beyond = [&](const char* field, int index) {
        return fail(arguments.file() + ": field " + field + "[" + std::to_string(index) +
                    "] reaches beyond the " + std::to_string(input.width) + "x" +
                    std::to_string(input.height) + " pixels");
    };
    for (int i = 0; i < file.pixel_size(); ++i) {
        const auto& pixel = file.pixel(i);
        if (!mask(pixel.x_px(), pixel.y_px(), 1, 1)) return beyond("pixel", i);
    }
    for (int i = 0; i < file.rectangle_size(); ++i) {
        const auto& r = file.rectangle(i);
        if (!mask(r.x_px(), r.y_px(), r.width_px(), r.height_px())) return beyond("rectangle", i);
    }
    return std::make_unique<PixelMask>(std::move(masked), input);
}

}  // namespace pursuit::sensor
