// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/pose_csv.hpp"

#include <array>
#include <utility>

#include "services/common/csv.hpp"

namespace pursuit::ctl {
namespace {

constexpr std::array<std::string_view, 19> columns = {"t_us",        "last_event_t_us",
                                                      "object_id",   "model",
                                                      "state",       "x_px",
                                                      "y_px",        "a00",
                                                      "a01",         "a10",
                                                      "a11",         "theta_rad",
                                                      "scale_x",     "scale_y",
                                                      "vx_px_s",     "vy_px_s",
                                                      "omega_rad_s", "confidence",
                                                      "residual_px"};

std::string joined(std::string_view separator) {
    std::string text;
    for (const auto column : columns) {
        if (!text.empty()) text += separator;
        text += column;
    }
    return text;
}

const std::string header = joined(",") + "\n";

/// Reads the columns of one row in their order; the first error stands for the row.
class RowReader {
 public:
    RowReader(const CsvReader& table, const std::array<std::size_t, columns.size()>& places)
        : table_(table), places_(places) {}

    std::string_view text() { return table_.field(places_[next_++]); }

    template <class Number>
    Number number() {
        const auto value = table_.number<Number>(places_[next_++]);
        if (!value && ok) ok = tl::unexpected(value.error());
        return value.value_or(Number{});
    }

    Result<void> ok;

 private:
    const CsvReader& table_;
    const std::array<std::size_t, columns.size()>& places_;
    std::size_t next_ = 0;
};

Result<PoseRow> read_row(const CsvReader& table,
                         const std::array<std::size_t, columns.size()>& places) {
    RowReader in(table, places);
    PoseRow row;
    row.t_us = in.number<std::int64_t>();
    row.last_event_t_us = in.number<std::int64_t>();
    row.object_id = in.number<std::uint32_t>();
    row.model = in.text();
    const auto state_text = in.text();
    const auto state = tracker::parse_track_state(state_text);
    row.pose.t_px.x() = in.number<double>();
    row.pose.t_px.y() = in.number<double>();
    row.pose.a(0, 0) = in.number<double>();
    row.pose.a(0, 1) = in.number<double>();
    row.pose.a(1, 0) = in.number<double>();
    row.pose.a(1, 1) = in.number<double>();
    row.theta_rad = in.number<double>();
    row.scale_x = in.number<double>();
    row.scale_y = in.number<double>();
    row.vx_px_s = in.number<double>();
    row.vy_px_s = in.number<double>();
    row.omega_rad_s = in.number<double>();
    row.confidence = in.number<float>();
    row.residual_px = in.number<float>();
    if (!in.ok) return tl::unexpected(in.ok.error());
    if (!state) {
        return fail(table.where() + ": column state: \"" + std::string(state_text) +
                    "\" is not a state");
    }
    row.state = *state;
    return row;
}

}  // namespace

const std::string_view pose_csv_header = header;

PoseRow row_of(const tracker::PoseRecord& record) {
    return {record.t_us,
            record.last_event_t_us,
            record.object_id,
            std::string(record.model),
            record.state,
            record.pose,
            record.theta_rad,
            record.scale_x,
            record.scale_y,
            record.velocity.vx_px_s,
            record.velocity.vy_px_s,
            record.velocity.omega_rad_s,
            record.confidence,
            record.mean_residual_px};
}

void append_pose_csv(std::string& text, const PoseRow& row) {
    text += std::to_string(row.t_us);
    text += ',';
    text += std::to_string(row.last_event_t_us);
    text += ',';
    text += std::to_string(row.object_id);
    text += ',';
    text += row.model;
    text += ',';
    text += tracker::to_string(row.state);
    for (const double value :
         {row.pose.t_px.x(), row.pose.t_px.y(), row.pose.a(0, 0), row.pose.a(0, 1),
          row.pose.a(1, 0), row.pose.a(1, 1), row.theta_rad, row.scale_x, row.scale_y, row.vx_px_s,
          row.vy_px_s, row.omega_rad_s}) {
        text += ',';
        append_number(text, value);
    }
    for (const float value : {row.confidence, row.residual_px}) {
        text += ',';
        append_number(text, value);
    }
    text += '\n';
}

Result<PoseCsvWriter> PoseCsvWriter::create(const std::string& path) {
    auto file = OutputFile::create(path);
    if (!file) return tl::unexpected(file.error());
    if (auto ok = file->write(pose_csv_header); !ok) return tl::unexpected(ok.error());
    return PoseCsvWriter(std::move(*file));
}

Result<void> PoseCsvWriter::write(const PoseRow& row) {
    line_.clear();
    append_pose_csv(line_, row);
    return file_.write(line_);
}

Result<std::vector<PoseRow>> read_pose_csv(const std::string& path) {
    auto table = CsvReader::open(path);
    if (!table) return tl::unexpected(table.error());
    std::array<std::size_t, columns.size()> places{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto place = table->required_column(columns[i]);
        if (!place) return tl::unexpected(place.error());
        places[i] = *place;
    }
    std::vector<PoseRow> rows;
    for (;;) {
        const auto more = table->next();
        if (!more) return tl::unexpected(more.error());
        if (!*more) return rows;
        auto row = read_row(*table, places);
        if (!row) return tl::unexpected(row.error());
        rows.push_back(std::move(*row));
    }
}

}  // namespace pursuit::ctl
