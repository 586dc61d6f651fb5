// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/truth.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
namespace {

constexpr std::uint64_t model_stream = 20;
constexpr std::uint64_t start_stream = 21;

/// Start errors are normal, but no start is further off than this many sigmas.
constexpr double start_cut = 2.5;

void set_linear(TruthRow& row, const Eigen::Matrix2d& a) {
    row.a00 = a(0, 0);
    row.a01 = a(0, 1);
    row.a10 = a(1, 0);
    row.a11 = a(1, 1);
    row.theta_rad = std::atan2(a(1, 0) - a(0, 1), a(0, 0) + a(1, 1));
    row.scale_x = a.col(0).norm();
    row.scale_y = a.col(1).norm();
}

/// The affine map nearest to `image_from_layer` at the model's points (least squares).
void set_pose(TruthRow& row, const PlanarMap& image_from_layer, const ContourModel& model) {
    if (image_from_layer.matrix.row(2).head<2>().isZero(0)) {
        const Point t = image_from_layer * model.centre;
        row.x_px = t.x();
        row.y_px = t.y();
        set_linear(row, image_from_layer.matrix.topLeftCorner<2, 2>());
        return;
    }
    // The points' centre of gravity is 0, so that shift and linear part separate.
    Eigen::Matrix2d image_model = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d model_model = Eigen::Matrix2d::Zero();
    Point mean = Point::Zero();
    for (const Point& m : model.points) {
        const Point p = image_from_layer * Point(m + model.centre);
        mean += p;
        image_model += p * m.transpose();
        model_model += m * m.transpose();
    }
    const auto count = static_cast<double>(model.points.size());
    mean /= count;
    const Eigen::Matrix2d a = image_model * model_model.inverse();
    row.x_px = mean.x();
    row.y_px = mean.y();
    set_linear(row, a);
    double sum_px2 = 0;
    for (const Point& m : model.points) {
        sum_px2 += (image_from_layer * Point(m + model.centre) - a * m - mean).squaredNorm();
    }
    row.fit_px = std::sqrt(sum_px2 / count);
}

/// A polygon in the image with its bounding box.
struct Cover {
    std::vector<Point> vertices;
    Point low;
    Point high;
};

bool covers(const std::vector<Cover>& front, const Point& p) {
    return std::any_of(front.begin(), front.end(), [&](const Cover& cover) {
        return (p.array() >= cover.low.array()).all() && (p.array() <= cover.high.array()).all() &&
               contains(cover.vertices, p);
    });
}

}  // namespace

std::vector<TruthRow> truth_at(const DrawnScene& scene, std::int64_t t_us) {
    const double t_s = static_cast<double>(t_us - scene.sensor.latency_us()) / 1e6;
    const auto last_tracked =
        std::find_if(scene.layers.rbegin(), scene.layers.rend(),
                     [](const DrawnLayer& layer) { return layer.tracked.has_value(); });
    std::vector<TruthRow> rows;
    std::vector<Cover> front;
    for (auto layer = scene.layers.begin(); layer != last_tracked.base(); ++layer) {
        const PlanarMap map = image_from_layer(scene, *layer, t_s);
        const bool there = layer->there(t_us - scene.sensor.latency_us());
        if (layer->tracked) {
            const auto& tracked = *layer->tracked;
            TruthRow row;
            row.t_us = t_us;
            row.object_id = tracked.object_id;
            row.model = tracked.name;
            set_pose(row, map, tracked.model);
            std::size_t visible = 0;
            for (const Point& m : tracked.model.points) {
                const Point p = map * Point(m + tracked.model.centre);
                const bool in_image = p.x() >= -0.5 && p.x() < scene.geometry.width - 0.5 &&
                                      p.y() >= -0.5 && p.y() < scene.geometry.height - 0.5;
                visible += there && in_image && !covers(front, p) ? 1 : 0;
            }
            row.visible_fraction =
                static_cast<double>(visible) / static_cast<double>(tracked.model.points.size());
            rows.push_back(row);
        }
        if (!there) continue;
        for (const auto& polygon : layer->polygons) {
            Cover cover;
            for (const Point& v : polygon.vertices) cover.vertices.push_back(map * v);
            cover.low = cover.high = cover.vertices.front();
            for (const Point& v : cover.vertices) {
                cover.low = cover.low.cwiseMin(v);
                cover.high = cover.high.cwiseMax(v);
            }
            front.push_back(std::move(cover));
        }
    }
    return rows;
}

std::vector<SceneModel> draw_models(const Scene& scene, const DrawnScene& drawn,
                                    std::uint64_t seed) {
    const auto& description = scene.description();
    const auto first_truth = truth_at(drawn, 0);
    Random clicks(seed, model_stream);
    Random starts(seed, start_stream);
    const auto error = [&](double sigma) {
        return sigma * std::clamp(starts.normal(), -start_cut, start_cut);
    };
    std::vector<SceneModel> models;
    for (const auto& layer : drawn.layers) {
        if (!layer.tracked) continue;
        SceneModel m;
        m.name = layer.tracked->name;
        m.object_id = layer.tracked->object_id;
        m.transform = layer.tracked->transform;
        m.search = layer.tracked->search;
        m.true_model = layer.tracked->model;
        m.model = description.model_noise_px() > 0
                      ? clicked(m.true_model, description.model_noise_px(), clicks)
                      : m.true_model;
        m.error_x_px = error(description.start_error_px());
        m.error_y_px = error(description.start_error_px());
        m.error_theta_rad = error(description.start_error_rad());
        m.error_scale = error(description.start_error_scale());
        if (m.transform == disk::SceneLayer::ISOMETRY) m.error_scale = 0;
        m.start = first_truth[models.size()];
        m.start.x_px += m.error_x_px;
        m.start.y_px += m.error_y_px;
        Eigen::Matrix2d a;
        a << m.start.a00, m.start.a01, m.start.a10, m.start.a11;
        set_linear(m.start, (1 + m.error_scale) *
                                Eigen::Rotation2Dd(m.error_theta_rad).toRotationMatrix() * a);
        models.push_back(std::move(m));
    }
    return models;
}

}  // namespace pursuit::sensor
