// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_wire.hpp"

#include <cstring>

namespace pursuit::tracker {
namespace {

constexpr std::size_t max_values = 32;  // NamedValue sequences, idl/models.idl

template <class Kind, class WireKind>
constexpr bool is_same(Kind kind, WireKind wire) {
    return static_cast<std::uint32_t>(kind) == static_cast<std::uint32_t>(wire);
}
// Here and in pursuitctl kinds go to the wire and come from it by their numbers.
static_assert(is_same(TransformKind::isometry, v1::TRANSFORM_ISOMETRY));
static_assert(is_same(TransformKind::similarity, v1::TRANSFORM_SIMILARITY));
static_assert(is_same(TransformKind::paper_affine, v1::TRANSFORM_PAPER_AFFINE));
static_assert(is_same(TransformKind::full_affine, v1::TRANSFORM_FULL_AFFINE));
static_assert(is_same(EstimatorKind::gradient, v1::ESTIMATOR_GRADIENT));
static_assert(is_same(EstimatorKind::kalman, v1::ESTIMATOR_KALMAN));
static_assert(is_same(StrategyKind::closest, v1::STRATEGY_CLOSEST));
static_assert(is_same(StrategyKind::reject_all, v1::STRATEGY_REJECT_ALL));
static_assert(is_same(StrategyKind::update_all, v1::STRATEGY_UPDATE_ALL));
static_assert(is_same(StrategyKind::weighted, v1::STRATEGY_WEIGHTED));
static_assert(is_same(StrategyKind::temporal, v1::STRATEGY_TEMPORAL));
static_assert(is_same(StrategyKind::spatiotemporal, v1::STRATEGY_SPATIOTEMPORAL));
static_assert(is_same(StrategyKind::probabilistic, v1::STRATEGY_PROBABILISTIC));
static_assert(is_same(TrackState::searching, v1::TRACK_SEARCHING));
static_assert(is_same(TrackState::tracking, v1::TRACK_TRACKING));
static_assert(is_same(TrackState::occluded, v1::TRACK_OCCLUDED));
static_assert(is_same(TrackState::lost, v1::TRACK_LOST));

/// An enum from the wire; any 32-bit number may have come.
template <class Kind, class WireKind>
CallResult<Kind> kind_of(WireKind wire, WireKind last, const char* field) {
    const auto value = static_cast<std::uint32_t>(wire);
    if (value <= static_cast<std::uint32_t>(last)) return static_cast<Kind>(value);
    return refuse(CallStatus::invalid_argument,
                  std::string(field) + ": " + std::to_string(value) + " is not one of 0 to " +
                      std::to_string(static_cast<std::uint32_t>(last)));
}

CallResult<Shape> shape_of(const std::string& name, const std::vector<v1::ModelPoint>& points,
                           const std::vector<v1::ModelEdge>& edges) {
    const auto check_count = [](const char* field, std::size_t count,
                                std::size_t most) -> CallResult<void> {
        if (count <= most) return {};
        return refuse(CallStatus::invalid_argument,
                      std::string(field) + ": " + std::to_string(count) + " entries, at most " +
                          std::to_string(most) + " are allowed");
    };
    if (auto ok = check_count("points", points.size(), max_shape_points); !ok) {
        return tl::unexpected(ok.error());
    }
    if (auto ok = check_count("edges", edges.size(), max_shape_edges); !ok) {
        return tl::unexpected(ok.error());
    }
    Shape shape;
    shape.name = name;
    shape.points_px.reserve(points.size());
    for (const auto& point : points) shape.points_px.emplace_back(point.x_px(), point.y_px());
    shape.edges.reserve(edges.size());
    for (const auto& edge : edges) shape.edges.push_back({edge.from_point(), edge.to_point()});
    return shape;
}

/// What RegisterModel and UpdateModel have in common.
template <class Content, class Wire>
CallResult<Content> content_of(const Wire& wire) {
    auto shape = shape_of(wire.name().to_string(), wire.points(), wire.edges());
    if (!shape) return tl::unexpected(shape.error());
    auto transform =
        kind_of<TransformKind>(wire.transform(), v1::TRANSFORM_FULL_AFFINE, "transform");
    if (!transform) return tl::unexpected(transform.error());
    auto estimator = kind_of<EstimatorKind>(wire.estimator(), v1::ESTIMATOR_KALMAN, "estimator");
    if (!estimator) return tl::unexpected(estimator.error());
    auto values = values_of(wire.parameters());
    if (!values) return tl::unexpected(values.error());
    Content content;
    content.shape = std::move(*shape);
    content.transform = *transform;
    content.estimator = *estimator;
    content.parameters = std::move(*values);
    return content;
}

v1::NamedValue named_value(const NamedValue& value) {
    v1::NamedValue wire;
    wire.name(value.name);
    wire.value(value.value);
    return wire;
}

void append(std::vector<v1::NamedValue>& wire, const std::vector<NamedValue>& values) {
    for (const auto& value : values) wire.push_back(named_value(value));
}

template <class Wire>
void put(Wire& wire, const Shape& shape) {
    for (const auto& point_px : shape.points_px) {
        v1::ModelPoint point;
        point.x_px(point_px.x());
        point.y_px(point_px.y());
        wire.points().push_back(point);
    }
    for (const auto& piece : shape.edges) {
        v1::ModelEdge edge;
        edge.from_point(piece.from);
        edge.to_point(piece.to);
        wire.edges().push_back(edge);
    }
}

}  // namespace

CallResult<std::vector<NamedValue>> values_of(const std::vector<v1::NamedValue>& wire) {
    if (wire.size() > max_values) {
        return refuse(CallStatus::invalid_argument,
                      "parameters: " + std::to_string(wire.size()) + " entries, at most " +
                          std::to_string(max_values) + " are allowed");
    }
    std::vector<NamedValue> values;
    for (const auto& value : wire) values.push_back({value.name().to_string(), value.value()});
    return values;
}

CallResult<Start> start_of(const v1::StartPose& wire, const std::string& field) {
    auto mode = kind_of<int>(wire.mode(), v1::START_SEARCH, (field + "mode").c_str());
    if (!mode) return tl::unexpected(mode.error());
    Start start;
    start.search = wire.mode() == v1::START_SEARCH;
    if (start.search) return start;
    start.pose.t_px = {wire.x_px(), wire.y_px()};
    start.pose.a << wire.a00(), wire.a01(), wire.a10(), wire.a11();
    start.velocity.vx_px_s = wire.vx_px_s();
    start.velocity.vy_px_s = wire.vy_px_s();
    start.velocity.omega_rad_s = wire.omega_rad_s();
    return start;
}

CallResult<Registration> registration_of(const v1::RegisterModel& wire) {
    auto registration = content_of<Registration>(wire);
    if (!registration) return registration;
    auto start = start_of(wire.start(), "start.");
    if (!start) return tl::unexpected(start.error());
    registration->object_id = wire.object_id();
    registration->start = *start;
    return registration;
}

CallResult<ObjectUpdate> update_of(const v1::UpdateModel& wire) {
    return content_of<ObjectUpdate>(wire);
}

CallResult<StrategyKind> strategy_of(v1::OcclusionStrategy wire) {
    return kind_of<StrategyKind>(wire, v1::STRATEGY_PROBABILISTIC, "strategy");
}

v1::StartPose start_pose(const Start& start) {
    v1::StartPose wire;
    wire.mode(start.search ? v1::START_SEARCH : v1::START_POSE);
    wire.x_px(start.pose.t_px.x());
    wire.y_px(start.pose.t_px.y());
    wire.a00(start.pose.a(0, 0));
    wire.a01(start.pose.a(0, 1));
    wire.a10(start.pose.a(1, 0));
    wire.a11(start.pose.a(1, 1));
    wire.vx_px_s(start.velocity.vx_px_s);
    wire.vy_px_s(start.velocity.vy_px_s);
    wire.omega_rad_s(start.velocity.omega_rad_s);
    return wire;
}

v1::RegisterModel register_model(const Registration& registration) {
    v1::RegisterModel wire;
    wire.object_id(registration.object_id);
    wire.name(registration.shape.name);
    wire.transform(static_cast<v1::TransformKind>(registration.transform));
    wire.estimator(static_cast<v1::EstimatorKind>(registration.estimator));
    wire.start(start_pose(registration.start));
    append(wire.parameters(), registration.parameters);
    put(wire, registration.shape);
    return wire;
}

v1::RegisteredModel registered_model(std::uint32_t sensor_id, const RegisteredObject& object) {
    v1::RegisteredModel wire;
    wire.sensor_id(sensor_id);
    wire.object_id(object.object_id);
    wire.registered(true);
    wire.name(object.shape.name);
    wire.effective_time_us(object.effective_time_us);
    wire.transform(static_cast<v1::TransformKind>(object.transform));
    wire.estimator(static_cast<v1::EstimatorKind>(object.estimator));
    wire.start(start_pose(object.start));
    append(wire.parameters(), values(object.parameters));
    put(wire, object.shape);
    return wire;
}

v1::TrackerSettings tracker_settings(const std::string& instance, std::uint32_t sensor_id,
                                     const Settings& settings) {
    v1::TrackerSettings wire;
    wire.instance(instance);
    wire.sensor_id(sensor_id);
    wire.effective_time_us(settings.effective_time_us);
    wire.strategy(static_cast<v1::OcclusionStrategy>(settings.strategy));
    append(wire.strategy_parameters(), values(settings.strategy_parameters));
    append(wire.parameters(), values(settings.tracker));
    append(wire.parameters(), values(settings.new_objects));
    return wire;
}

void fill(v1::ObjectPose& wire, const PoseRecord& record) {
    wire.object_id(record.object_id);
    wire.stream_id(record.stream_id);
    wire.t_us(record.t_us);
    wire.last_event_t_us(record.last_event_t_us);
    wire.model(std::string(record.model));
    wire.transform(static_cast<v1::TransformKind>(record.transform));
    wire.state(static_cast<v1::TrackState>(record.state));
    wire.x_px(record.pose.t_px.x());
    wire.y_px(record.pose.t_px.y());
    wire.a00(record.pose.a(0, 0));
    wire.a01(record.pose.a(0, 1));
    wire.a10(record.pose.a(1, 0));
    wire.a11(record.pose.a(1, 1));
    wire.theta_rad(record.theta_rad);
    wire.scale_x(record.scale_x);
    wire.scale_y(record.scale_y);
    wire.vx_px_s(record.velocity.vx_px_s);
    wire.vy_px_s(record.velocity.vy_px_s);
    wire.omega_rad_s(record.velocity.omega_rad_s);
    wire.scale_x_rate_per_s(record.velocity.scale_x_rate_per_s);
    wire.scale_y_rate_per_s(record.velocity.scale_y_rate_per_s);
    wire.pose_covariance(record.pose_covariance);
    wire.velocity_covariance(record.velocity_covariance);
    wire.confidence(record.confidence);
    wire.mean_residual_px(record.mean_residual_px);
    wire.event_rate_hz(record.event_rate_hz);
    wire.events_used(record.events_used);
}

v1::StatusCode status_code(CallStatus status) {
    switch (status) {
        case CallStatus::invalid_argument:
            return v1::STATUS_INVALID_ARGUMENT;
        case CallStatus::not_found:
            return v1::STATUS_NOT_FOUND;
        case CallStatus::already_exists:
            return v1::STATUS_ALREADY_EXISTS;
        case CallStatus::limit_exceeded:
            return v1::STATUS_LIMIT_EXCEEDED;
        case CallStatus::unsupported:
            return v1::STATUS_UNSUPPORTED;
    }
    return v1::STATUS_FAILED;
}

}  // namespace pursuit::tracker
