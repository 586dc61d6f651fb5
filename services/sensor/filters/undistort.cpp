// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/undistort.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "services/common/text_format.hpp"
#include "services/sensor/filters/lens.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::uint32_t outside = 0xffff'ffff;  // no pixel: y has 15 bits

class Undistort final : public Filter {
 public:
    Undistort(std::vector<std::uint32_t> table, Geometry input, Geometry output)
        : table_(std::move(table)), input_(input), output_(output) {}

    std::size_t apply(std::span<Event> events) override {
        std::size_t kept = 0;
        for (Event event : events) {
            const auto pixel = table_[std::size_t{event.y} * input_.width + event.x];
            event.x = static_cast<std::uint16_t>(pixel);
            event.y = static_cast<std::uint16_t>(pixel >> 16);
            events[kept] = event;
            kept += static_cast<std::size_t>(pixel != outside);
        }
        return kept;
    }

    Geometry geometry() const override { return output_; }
    bool by_pixel_alone() const override { return true; }

 private:
    std::vector<std::uint32_t> table_;  // y << 16 | x, by y·width + x
    Geometry input_;
    Geometry output_;
};

}  // namespace

Result<std::unique_ptr<Filter>> make_undistort(const FilterArguments& arguments, Geometry input) {
    disk::Calibration file;
    if (auto ok = read_text_file(arguments.file(), file, nullptr, Quoting::nothing); !ok) {
        return tl::unexpected(ok.error());
    }
    if (file.width() != input.width || file.height() != input.height) {
        return fail(arguments.file() + ": is for " + std::to_string(file.width()) + "x" +
                    std::to_string(file.height()) + " pixels, the events are of " +
                    std::to_string(input.width) + "x" + std::to_string(input.height));
    }
    const auto& to = file.output();
    const Geometry output{
        static_cast<std::uint16_t>(to.has_width() ? to.width() : file.width()),
        static_cast<std::uint16_t>(to.has_height() ? to.height() : file.height())};
    const double fx = to.has_fx_px() ? to.fx_px() : file.fx_px();
    const double fy = to.has_fy_px() ? to.fy_px() : file.fy_px();
    const double cx = to.has_cx_px() ? to.cx_px() : file.cx_px();
    const double cy = to.has_cy_px() ? to.cy_px() : file.cy_px();
    const Lens lens(file);
    std::vector<std::uint32_t> table;
    table.reserve(std::size_t{input.width} * input.height);
    for (int y = 0; y < input.height; ++y) {
        for (int x = 0; x < input.width; ++x) {
            const auto ray = lens.undistort(
                {(x - file.cx_px()) / file.fx_px(), (y - file.cy_px()) / file.fy_px()});
            const double u = ray ? std::round(ray->x * fx + cx) : -1;
            const double v = ray ? std::round(ray->y * fy + cy) : -1;
            const bool inside = u >= 0 && v >= 0 && u < output.width && v < output.height;
            table.push_back(inside ? static_cast<std::uint32_t>(v) << 16 |
                                         static_cast<std::uint32_t>(u)
                                   : outside);
        }
    }
    return std::make_unique<Undistort>(std::move(table), input, output);
}

}  // namespace pursuit::sensor
