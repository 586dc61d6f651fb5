// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/track_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "services/common/csv.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::ctl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The columns of a table; those without a value need not be there.
struct Columns {
    std::size_t t_us = 0;
    std::optional<std::size_t> model, object_id, state, confidence, visible;
    std::optional<std::size_t> theta, scale_x, scale_y;
    std::array<std::optional<std::size_t>, 6> pose;  ///< Of the matrix, all or none.
};

Result<Columns> columns_of(const CsvReader& table) {
    Columns columns;
    Result<void> ok;
    const auto required = [&](const char* name) {
        const auto found = table.required_column(name);
        if (!found && ok) ok = tl::unexpected(found.error());
        return found.value_or(0);
    };
    columns.t_us = required("t_us");
    columns.pose[0] = required("x_px");
    columns.pose[1] = required("y_px");
    if (table.column("a00")) {
        constexpr const char* names[] = {"a00", "a01", "a10", "a11"};
        for (std::size_t i = 0; i < 4; ++i) columns.pose[2 + i] = required(names[i]);
    } else if (const auto theta = table.column("theta_rad")) {
        columns.theta = theta;
        columns.scale_x = table.column("scale_x");
        columns.scale_y = table.column("scale_y");
    } else if (ok) {
        return fail(table.path() + ": has neither a column a00 nor one theta_rad");
    }
    if (!ok) return tl::unexpected(ok.error());
    columns.model = table.column("model");
    columns.object_id = table.column("object_id");
    columns.state = table.column("state");
    columns.confidence = table.column("confidence");
    columns.visible = table.column("visible_fraction");
    return columns;
}

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
Result<std::string> state_of(const CsvReader& table, std::optional<std::size_t> column) {
    const auto written = text_of(table, column);
    std::string text = written;
    if (text.empty()) return "TRACKING";
    if (text == "0") return "SEARCHING";
    if (text == "1") return "TRACKING";
    if (text == "2") return "OCCLUDED";
    if (text == "3") return "LOST";
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    text = text.substr(text.rfind('_') + 1);
    if (tracker::parse_track_state(text)) return text;
    return fail(table.where() + ": column state: \"" + written + "\" is not a state");
}

Result<void> read_row(const CsvReader& table, const Columns& columns, ObjectRows& rows) {
    if (auto ok = table.check_length(); !ok) return ok;
    const auto t_us = table.number<double>(columns.t_us);
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
    auto state = state_of(table, columns.state);
    if (!state) return tl::unexpected(state.error());
    rows.t_us.push_back(std::trunc(*t_us));
    rows.pose.push_back(pose);
    rows.state.push_back(std::move(*state));
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
    const auto columns = columns_of(*table);
    if (!columns) return tl::unexpected(columns.error());
    std::vector<ObjectRows> objects;
    for (;;) {
        const auto more = table->next();
        if (!more) return tl::unexpected(more.error());
        if (!*more) break;
        const auto model = text_of(*table, columns->model);
        const auto object_id = text_of(*table, columns->object_id);
        auto rows = std::find_if(objects.begin(), objects.end(), [&](const ObjectRows& known) {
            return known.model == model && known.object_id == object_id;
        });
        if (rows == objects.end()) {
            objects.push_back({model, object_id, {}, {}, {}, {}, {}});
            rows = objects.end() - 1;
        }
        if (auto ok = read_row(*table, *columns, *rows); !ok) {
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
