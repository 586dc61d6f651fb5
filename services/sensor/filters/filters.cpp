// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/filters.hpp"

#include <algorithm>

#include "services/sensor/filters/background_activity.hpp"
#include "services/sensor/filters/hot_pixel.hpp"
#include "services/sensor/filters/pixel_mask.hpp"
#include "services/sensor/filters/polarity.hpp"
#include "services/sensor/filters/rate_control.hpp"
#include "services/sensor/filters/refractory.hpp"
#include "services/sensor/filters/region_of_interest.hpp"
#include "services/sensor/filters/turn.hpp"
#include "services/sensor/filters/undistort.hpp"

namespace pursuit::sensor {
namespace {

constexpr FilterKind all_kinds[] = {
    {"region_of_interest", "keeps what is inside a rectangle, or outside of it",
     region_of_interest_parameters, false, make_region_of_interest},
    {"pixel_mask", "drops the events of listed pixels", {}, true, make_pixel_mask},
    {"hot_pixel", "finds pixels that fire far more than their neighbours, and drops their events",
     hot_pixel_parameters, false, make_hot_pixel},
    {"refractory", "after an event, drops those of the same pixel for a time",
     refractory_parameters, false, make_refractory},
    {"background_activity", "drops events without recent ones in their neighbourhood",
     background_activity_parameters, false, make_background_activity},
    {"polarity", "keeps one polarity, or exchanges the two", polarity_parameters, false,
     make_polarity},
    {"geometry", "transposes, rotates and flips the image", turn_parameters, false, make_turn},
    {"rate_control", "thins events evenly where there are more than a rate",
     rate_control_parameters, false, make_rate_control},
    {"undistort",
     "moves pixels to where a lens without distortion has them",
     {},
     true,
     make_undistort},
};

}  // namespace

std::span<const FilterKind> filter_kinds() { return all_kinds; }

Result<std::size_t> find_filter_kind(std::string_view name) {
    std::string names;
    for (std::size_t i = 0; i < std::size(all_kinds); ++i) {
        if (all_kinds[i].name == name) return i;
        names += (i == 0 ? "" : ", ") + std::string(all_kinds[i].name);
    }
    return fail("no filter is named \"" + std::string(name.substr(0, 64)) + "\"; there are " +
                names);
}

Result<void> check_filter(const FilterSetting& setting) {
    const auto kind = find_filter_kind(setting.filter);
    if (!kind) return tl::unexpected(kind.error());
    const auto arguments = FilterArguments::of(setting, all_kinds[*kind].parameters);
    if (!arguments) return tl::unexpected(arguments.error());
    if (all_kinds[*kind].takes_file == setting.file.empty()) {
        return fail(setting.file.empty() ? "file is missing" : "file: this filter takes none");
    }
    return {};
}

Result<std::unique_ptr<Filter>> make_filter(const FilterSetting& setting, Geometry input) {
    if (auto ok = check_filter(setting); !ok) return tl::unexpected(ok.error());
    const auto& kind = all_kinds[*find_filter_kind(setting.filter)];
    return kind.make(*FilterArguments::of(setting, kind.parameters), input);
}

}  // namespace pursuit::sensor
