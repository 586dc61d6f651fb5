// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/scene.hpp"

#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "services/common/settings.hpp"
#include "services/common/small_file.hpp"
#include "services/common/text_format.hpp"
#include "services/sensor/scene/builtin_scenes.hpp"
#include "services/sensor/scene/polygon.hpp"
#include "services/sensor/scene/shapes.hpp"

namespace pursuit::sensor {
namespace {

using Problem = std::optional<Error>;

Error problem(const std::string& field, const std::string& what) { return {field + what, field}; }

constexpr std::size_t most_file_mib = 16;

Problem interval_problem(const disk::Interval& interval, const std::string& where, double least,
                         double most) {
    if (interval.low() > interval.high()) return problem(where, ": low is above high");
    if (interval.low() < least || interval.high() > most) {
        return problem(where,
                       ": must lie within " + std::to_string(least) + " … " + std::to_string(most));
    }
    return std::nullopt;
}

Problem trajectory_problem(const disk::SceneTrajectory& t, const std::string& where) {
    double grow = 0;
    double tilt = 0;
    for (const auto& sine : t.sine()) {
        using Sine = disk::SceneSine;
        const auto target = sine.target();
        const double amplitude = std::abs(sine.amplitude());
        if (target == Sine::SCALE || target == Sine::SCALE_X || target == Sine::SCALE_Y) {
            grow += amplitude;
        }
        if (target == Sine::TILT_X || target == Sine::TILT_Y) tilt = std::max(tilt, amplitude);
    }
    if (grow > 0.9) return problem(where + ".sine", ": scale amplitudes add up to more than 0.9");
    if (tilt > 1.2) return problem(where + ".sine", ": tilts by more than 1.2 rad");
    for (int i = 1; i < t.key_size(); ++i) {
        if (t.key(i).t_s() <= t.key(i - 1).t_s()) {
            return problem(where + ".key[" + std::to_string(i) + "]",
                           ": t_s is not after the key before");
        }
    }
    return std::nullopt;
}

bool plain_name(const std::string& name) {
    return !name.empty() && name.find_first_not_of(
                                "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-") == std::string::npos;
}

/// The largest distance of a corner from the layer's origin.
double reach_px(const disk::SceneLayer& layer) {
    double reach = 0;
    const auto look = [&](double x, double y) { reach = std::max(reach, std::hypot(x, y)); };
    for (const auto& polygon : layer.polygon()) {
        for (int i = 0; i + 1 < polygon.xy_px_size(); i += 2) {
            look(polygon.xy_px(i), polygon.xy_px(i + 1));
        }
    }
    if (layer.has_shape()) {
        for (const auto& polygon : shape_polygons(layer.shape())) {
            for (const Point& p : polygon.vertices) look(p.x(), p.y());
        }
    }
    if (layer.has_clutter()) {
        const auto& c = layer.clutter();
        look(std::max(std::abs(c.x_px().low()), std::abs(c.x_px().high())) + c.size_px().high(),
             std::max(std::abs(c.y_px().low()), std::abs(c.y_px().high())) + c.size_px().high());
    }
    return reach;
}

/// A tilted plane must stay in front of the camera.
Problem tilt_problem(const disk::SceneLayer& layer, const std::string& where) {
    const auto& t = layer.trajectory();
    bool tilted = false;
    double grow = 1;
    for (const auto& sine : t.sine()) {
        using Sine = disk::SceneSine;
        const auto target = sine.target();
        const bool tilts = target == Sine::TILT_X || target == Sine::TILT_Y;
        tilted |= tilts;
        const bool shifts = target == Sine::X || target == Sine::Y || target == Sine::THETA;
        if (!tilts && !shifts) grow += std::abs(sine.amplitude());
    }
    if (!tilted) return std::nullopt;
    double key_scale = 1;
    for (const auto& key : t.key()) key_scale = std::max(key_scale, key.scale());
    grow *= (1 + layer.variation().size_share()) * (1 + layer.variation().scale_share());
    if (reach_px(layer) * t.scale() * key_scale * grow > 0.5 * t.focal_px()) {
        return problem(where, ": a tilted layer must be smaller than half of focal_px");
    }
    return std::nullopt;
}

Problem layer_problem(const disk::SceneLayer& layer, const std::string& where) {
    if (layer.polygon().empty() && !layer.has_shape() && !layer.has_clutter()) {
        return problem(where, ": has neither polygon, shape nor clutter");
    }
    bool contour = layer.has_shape();
    for (int i = 0; i < layer.polygon_size(); ++i) {
        const auto& xy = layer.polygon(i).xy_px();
        const std::string name = where + ".polygon[" + std::to_string(i) + "]";
        if (xy.size() % 2 != 0) return problem(name, ": xy_px has an odd number of values");
        std::vector<Point> vertices;
        for (int k = 0; k < xy.size(); k += 2) vertices.emplace_back(xy[k], xy[k + 1]);
        if (const auto error = polygon_error(vertices)) return problem(name, " " + *error);
        contour |= layer.polygon(i).contour();
    }
    if (layer.has_clutter()) {
        const auto& c = layer.clutter();
        for (const auto* side : {&c.x_px(), &c.y_px()}) {
            if (auto p = interval_problem(*side, where + ".clutter", -1e5, 1e5)) return p;
        }
        if (auto p = interval_problem(c.size_px(), where + ".clutter.size_px", 2, 4096)) return p;
        if (c.has_reflectance()) {
            const auto name = where + ".clutter.reflectance";
            if (auto p = interval_problem(c.reflectance(), name, 0.01, 1)) return p;
        }
    }
    if (!layer.track().empty() || layer.has_track()) {
        if (!plain_name(layer.track())) {
            return problem(where + ".track", ": must be letters, digits, _ and - only");
        }
        if (layer.has_clutter()) return problem(where, ": clutter cannot be tracked");
        if (!contour) return problem(where, ": is tracked, but no polygon is its contour");
    }
    if (layer.has_to_s() && layer.to_s() <= layer.from_s()) {
        return problem(where + ".to_s", ": is not after from_s");
    }
    if (layer.variation().has_reflectance()) {
        const auto name = where + ".variation.reflectance";
        if (auto p = interval_problem(layer.variation().reflectance(), name, 0.01, 1)) return p;
    }
    if (auto p = trajectory_problem(layer.trajectory(), where + ".trajectory")) return p;
    return tilt_problem(layer, where);
}

Problem scene_problem(const disk::Scene& scene) {
    if (!plain_name(scene.name())) {
        return problem("name", ": must be letters, digits, _ and - only");
    }
    std::set<std::string> names;
    for (int i = 0; i < scene.layer_size(); ++i) {
        const std::string where = "layer[" + std::to_string(i) + "]";
        if (auto p = layer_problem(scene.layer(i), where)) return p;
        if (scene.layer(i).has_track() && !names.insert(scene.layer(i).track()).second) {
            return problem(where + ".track",
                           ": \"" + scene.layer(i).track() + "\" is tracked twice");
        }
    }
    for (const auto& sine : scene.camera().sine()) {
        const auto t = sine.target();
        if (t != disk::SceneSine::X && t != disk::SceneSine::Y && t != disk::SceneSine::THETA &&
            t != disk::SceneSine::SCALE) {
            return problem("camera.sine", ": a camera has X, Y, THETA and SCALE only");
        }
    }
    if (scene.has_background()) {
        if (auto p = interval_problem(scene.background(), "background", 0.01, 1)) return p;
    }
    return trajectory_problem(scene.camera(), "camera");
}

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& name,
                          const std::vector<std::string>& settings) {
    Scene scene;
    FieldPlaces places;
    if (auto ok = parse_text(text, name, scene.description_, &places); !ok) {
        return tl::unexpected(ok.error());
    }
    if (auto ok = apply_settings(settings, scene.description_, &places); !ok) {
        return tl::unexpected(ok.error());
    }
    if (const auto wrong = scene_problem(scene.description_)) {
        return tl::unexpected(places.located(*wrong, name));
    }
    return scene;
}

Result<Scene> load_scene(const std::string& path_or_builtin_name,
                         const std::vector<std::string>& settings) {
    for (const auto& builtin : builtin_scenes()) {
        if (builtin.name == path_or_builtin_name) {
            return parse_scene(builtin.text, path_or_builtin_name, settings);
        }
    }
    const std::string& path = path_or_builtin_name;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        std::string names;
        for (const auto& builtin : builtin_scenes()) names += " " + std::string(builtin.name);
        return fail(path + ": no such file, and no built-in scene; these are built in:" + names);
    }
    const auto text = read_small_file(path, most_file_mib);
    if (!text) return tl::unexpected(text.error());
    return parse_scene(*text, path, settings);
}

std::vector<std::string> list_builtin_scenes() {
    std::vector<std::string> names;
    for (const auto& builtin : builtin_scenes()) names.emplace_back(builtin.name);
    return names;
}

}  // namespace pursuit::sensor
