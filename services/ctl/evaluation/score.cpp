// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "services/common/csv.hpp"

namespace pursuit::ctl {
namespace {

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
            out += code;
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string json(const MaybeNumber& value) {
    if (!value || !std::isfinite(*value)) return "null";
    std::string text;
    append_number(text, *value);
    return text;
}

std::string cell(const MaybeNumber& value) {
    if (!value) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", *value);
    return text;
}

const char* word(bool value) { return value ? "true" : "false"; }

}  // namespace

const std::vector<ScoreField>& score_fields() {
    static const std::vector<ScoreField> fields = {
        {"E", &Score::error},
        {"E_p95", &Score::error_p95},
        {"E_max", &Score::error_max},
        {"E_final", &Score::error_final},
        {"E_visible", &Score::error_visible},
        {"E_tracking", &Score::error_tracking},
        {"lies", &Score::lies},
        {"lies_s", &Score::lies_s},
        {"tracking_fraction", &Score::tracking_fraction},
        {"coverage", &Score::coverage},
        {"Tx_bias", &Score::x_bias},
        {"Tx_sigma", &Score::x_sigma},
        {"Ty_bias", &Score::y_bias},
        {"Ty_sigma", &Score::y_sigma},
        {"theta_bias", &Score::theta_bias},
        {"theta_sigma", &Score::theta_sigma},
        {"t_whole_in_view_s", &Score::whole_in_view_s},
        {"t_first_pose_s", &Score::first_pose_s},
        {"t_acquired_s", &Score::acquired_s},
        {"t_first_lost_s", &Score::first_lost_s},
        {"E_symmetric", &Score::symmetric_error},
        {"E_symmetric_p95", &Score::symmetric_error_p95},
        {"E_symmetric_max", &Score::symmetric_error_max},
        {"lies_symmetric", &Score::symmetric_lies},
        {"speed_error_pct", &Score::speed_error_pct},
        {"velocity_error_pct", &Score::velocity_error_pct},
        {"omega_error_pct", &Score::omega_error_pct},
        {"D1", &Score::d1},
        {"D1_sigma", &Score::d1_sigma},
        {"D1_events", &Score::d1_events},
    };
    return fields;
}

std::string to_json(const std::vector<Score>& scores) {
    std::string text = "{";
    for (const auto& score : scores) {
        text += text.size() == 1 ? "\n " : ",\n ";
        text += quoted(score.object) + ": {\n  \"lost\": " + word(score.lost) +
                ",\n  \"rows\": " + std::to_string(score.pose_rows);
        if (score.symmetric_lost) {
            text += std::string(",\n  \"lost_symmetric\": ") + word(*score.symmetric_lost);
        }
        for (const auto& field : score_fields()) {
            text += std::string(",\n  \"") + field.name + "\": " + json(score.*field.member);
        }
        text += "\n }";
    }
    return text + (scores.empty() ? "}\n" : "\n}\n");
}

std::string to_table(const std::vector<Score>& scores) {
    std::string text;
    const auto line = [&](const std::string& name, auto value_of) {
        char buffer[64];
        std::snprintf(buffer, sizeof buffer, "%-20s", name.c_str());
        text += buffer;
        for (const auto& score : scores) {
            std::snprintf(buffer, sizeof buffer, " %14.32s", value_of(score).c_str());
            text += buffer;
        }
        text += '\n';
    };
    line("", [](const Score& score) { return score.object; });
    line("lost", [](const Score& score) { return std::string(score.lost ? "LOST" : "no"); });
    for (const auto& field : score_fields()) {
        // Lines that say nothing of any object would only hide the others.
        if (std::none_of(scores.begin(), scores.end(),
                         [&](const Score& score) { return (score.*field.member).has_value(); })) {
            continue;
        }
        line(field.name, [&](const Score& score) { return cell(score.*field.member); });
    }
    return text;
}

}  // namespace pursuit::ctl
