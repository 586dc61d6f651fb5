// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/track_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "services/common/csv.hpp"

namespace pursuit::ctl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The columns of a table that are there.
struct Columns {
    explicit Columns(const CsvReader& table)
        : model(table.column("model")),
          object_id(table.column("object_id")),
          state(table.column("state")),
          confidence(table.column("confidence")),
          visible(table.column("visible_fraction")),
          theta(table.column("theta_rad")),
          scale_x(table.column("scale_x")),
          scale_y(table.column("scale_y")),
          pose{table.column("x_px"), table.column("y_px"), table.column("a00"),
               table.column("a01"),  table.column("a10"),  table.column("a11")} {}

    std::optional<std::size_t> model, object_id, state, confidence, visible;
    std::optional<std::size_t> theta, scale_x, scale_y;
    std::array<std::optional<std::size_t>, 6> pose;
};

std::string text_of(const CsvReader& table, std::optional<std::size_t> column) {
    return column ? std::string(table.field(*column)) : std::string();
}

/// The number in a column, `otherwise` where the table has no such column or the row no value.
Result<double> number_of(const CsvReader& table, std::optional<std::size_t> column,
                         double otherwise) {
    if (!column || table.field(*column).empty()) return otherwise;
    return table.number<double>(*column);
}

/// "OCCLUDED" of OCCLUDED, occluded, 2 or POSE_STATE_OCCLUDED.
std::string state_of(std::string text) {
    if (text.empty()) return "TRACKING";
    if (text == "0") return "SEARCHING";
    if (text == "1") return "TRACKING";
    if (text == "2") return "OCCLUDED";
    if (text == "3") return "LOST";
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text.substr(text.rfind('_') + 1);
}

Result<void> read_row(const CsvReader& table, const Columns& columns, std::size_t time_column,
                      ObjectRows& rows) {
    const auto t_us = table.number<double>(time_column);
    if (!t_us) return tl::unexpected(t_us.error());
    if (!std::isfinite(*t_us)) return fail(table.where() + ": column t_us: must be finite");
    Result<void> ok;
    const auto number = [&](std::optional<std::size_t> column, double otherwise) {
        const auto value = number_of(table, column, otherwise);
        if (!value && ok) ok = tl::unexpected(value.error());
        return value.value_or(otherwise);
    };
    PoseNumbers pose{};
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = number(columns.pose[i], nan);
    if (!columns.pose[2]) {
        const double theta = number(columns.theta, nan);
        const double sx = number(columns.scale_x, 1);
        const double sy = number(columns.scale_y, 1);
        pose[2] = std::cos(theta) * sx;
        pose[3] = -std::sin(theta) * sy;
        pose[4] = std::sin(theta) * sx;
        pose[5] = std::cos(theta) * sy;
    }
    rows.t_us.push_back(std::trunc(*t_us));
    rows.pose.push_back(pose);
    rows.state.push_back(state_of(text_of(table, columns.state)));
    rows.confidence.push_back(number(columns.confidence, 1));
    rows.visible.push_back(number(columns.visible, 1));
    return ok;
}

template <class Value>
void reorder(std::vector<Value>& values, const std::vector<std::size_t>& order) {
    std::vector<Value> sorted;
    sorted.reserve(order.size());
    for (const auto i : order) sorted.push_back(std::move(values[i]));
    values = std::move(sorted);
}

void sort_by_time(ObjectRows& rows) {
    std::vector<std::size_t> order(rows.t_us.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t l, std::size_t r) { return rows.t_us[l] < rows.t_us[r]; });
    reorder(rows.t_us, order);
    reorder(rows.pose, order);
    reorder(rows.state, order);
    reorder(rows.confidence, order);
    reorder(rows.visible, order);
}

}  // namespace

Result<std::vector<ObjectRows>> read_object_rows(const std::string& path) {
    auto table = CsvReader::open(path);
    if (!table) return tl::unexpected(table.error());
    const auto time_column = table->required_column("t_us");
    if (!time_column) return tl::unexpected(time_column.error());
    const Columns columns(*table);
    std::vector<ObjectRows> objects;
    for (;;) {
        const auto more = table->next();
        if (!more) return tl::unexpected(more.error());
        if (!*more) break;
        const auto model = text_of(*table, columns.model);
        const auto object_id = text_of(*table, columns.object_id);
        auto rows = std::find_if(objects.begin(), objects.end(), [&](const ObjectRows& known) {
            return known.model == model && known.object_id == object_id;
        });
        if (rows == objects.end()) {
            objects.push_back({model, object_id, {}, {}, {}, {}, {}});
            rows = objects.end() - 1;
        }
        if (auto ok = read_row(*table, columns, *time_column, *rows); !ok) {
            return tl::unexpected(ok.error());
        }
    }
    for (auto& rows : objects) sort_by_time(rows);
    return objects;
}

double angle_rad(const PoseNumbers& pose) {
    return std::atan2(pose[4] - pose[3], pose[2] + pose[5]);
}

}  // namespace pursuit::ctl
