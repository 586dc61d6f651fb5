// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "services/common/atomic_file.hpp"
#include "services/common/output_file.hpp"
#include "services/ctl/commands/mcap_info.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/grey/read_exposures.hpp"

namespace pursuit::ctl {
namespace {

constexpr double longest_s = 9e12;  // as us within 63 bits

struct GreyOptions {
    std::string events;
    std::string output;
    std::string format;
    std::string geometry;
    double at_s = 0;
    std::uint32_t sensor_id = 0;
};

int grey(const GreyOptions& options) {
    if (!(options.at_s >= 0 && options.at_s <= longest_s)) {
        return report({"--at: must be 0 to 9e12 s"});
    }
    const auto geometry = geometry_of(options.geometry);
    if (!geometry) return report(geometry.error());
    const auto at_us = std::llround(options.at_s * 1e6);
    sensor::ReadOptions how;
    how.format = options.format;
    how.geometry = *geometry;
    if (auto ok = check_is_not_input(options.output, options.events); !ok) {
        return report(ok.error());
    }
    const auto image = is_mcap(options.events)
                           ? grey_of_mcap(options.events, options.sensor_id, at_us)
                           : grey_of_events(options.events, how, at_us);
    if (!image) return report(image.error());
    const auto png = grey_png(*image);
    if (!png) return report(png.error());
    const std::string_view bytes(reinterpret_cast<const char*>(png->data()), png->size());
    if (auto ok = write_output(options.output, bytes); !ok) return report(ok.error());
    const auto pixels = image->integration_us().size();
    std::fprintf(summary_of(options.output), "%s: %ux%u, %zu of %zu pixels measured by %.6f s\n",
                 options.output.c_str(), unsigned{image->geometry().width},
                 unsigned{image->geometry().height}, image->measured_pixels(), pixels,
                 options.at_s);
    return exit_success;
}

}  // namespace

Run define_grey(CLI::App& app) {
    auto options = std::make_shared<GreyOptions>();
    app.add_option("--events", options->events, "Recording with exposure measurements: ES, MCAP")
        ->required();
    app.add_option("--at", options->at_s, "Seconds of the recording's time")->required();
    app.add_option("--output", options->output, "PNG to write")->required();
    app.add_option("--format", options->format, "Format, where the file does not tell");
    app.add_option("--geometry", options->geometry, geometry_help);
    app.add_option("--sensor", options->sensor_id, "MCAP: the sensor's id; else the first there");
    return [options] { return grey(*options); };
}

}  // namespace pursuit::ctl
