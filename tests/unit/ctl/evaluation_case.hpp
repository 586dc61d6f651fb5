// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "services/sensor/formats/dat_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pursuit::ctl {

/// Two moving shapes with poses that have every fault an evaluation knows: late, early, frozen,
/// missing, not a number, confident and wrong.
class EvaluationCase {
 public:
    EvaluationCase() {
        write_truth();
        write_poses();
        folder_.file("model_square.csv", "x_px,y_px\n-9,-9\n9,-9\n9,9\n-9,9\n");
        folder_.file("model_bar.csv", "x_px,y_px\n-14,-2\n0,-2\n14,-2\n14,2\n0,2\n-14,2\n");
        write_events();
    }

    std::string path(const std::string& name) const { return folder_.path(name); }

 private:
    static constexpr int end_ms = 1300;

    struct Place {
        double x, y, theta, scale;
    };

    static Place square_at(double t_s) {
        return {60 + 80 * t_s, 50 + 10 * std::sin(6 * t_s), 4 * t_s, 1 + 0.2 * t_s};
    }
    static Place bar_at(double t_s) { return {150 - 30 * t_s, 120, -0.3, 1}; }

    static std::string numbers(const Place& place) {
        const double c = std::cos(place.theta) * place.scale;
        const double s = std::sin(place.theta) * place.scale;
        char text[240];
        std::snprintf(text, sizeof text, "%.12g,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g",
                      place.x, place.y, c, -s, s, c, place.theta, place.scale, place.scale);
        return text;
    }

    void write_truth() {
        std::string text =
            "t_us,object_id,model,x_px,y_px,a00,a01,a10,a11,theta_rad,scale_x,scale_y,"
            "visible_fraction\n";
        for (int ms = 0; ms <= end_ms; ++ms) {
            const auto at = std::to_string(1000 * ms);
            text += at + ",1,square," + numbers(square_at(ms * 1e-3)) + "," +
                    (ms < 40 ? "0.4" : "1") + "\n";
            text += at + ",2,bar," + numbers(bar_at(ms * 1e-3)) + ",0.9\n";
        }
        folder_.file("truth.csv", text);
    }

    void write_poses() {
        std::string text =
            "t_us,object_id,model,state,x_px,y_px,a00,a01,a10,a11,theta_rad,scale_x,scale_y,"
            "confidence\n";
        for (int ms = 20; ms <= end_ms; ++ms) {
            if (ms % 97 < 5) continue;  // a gap: longer than what counts as fresh
            const int t_us = 1000 * ms - (ms % 7 == 0 ? 400 : 0);
            const double t_s = t_us * 1e-6;
            auto square = square_at(t_s);
            square.x += 0.4 + (ms > 700 && ms < 800 ? 12 : 0);
            square.y += 0.3 * std::sin(40 * t_s);
            square.theta += 0.02 * std::cos(30 * t_s);
            auto bar = bar_at(t_s < 0.9 ? t_s : 0.9);  // stops following
            bar.y -= 0.5;
            const std::string square_state = ms < 60        ? "SEARCHING"
                                             : ms % 50 == 0 ? "LOST"
                                                            : "TRACKING";
            const std::string square_numbers = ms == 500 ? "nan,1,1,0,0,1,0,1,1" : numbers(square);
            text += std::to_string(t_us) + ",1,square," + square_state + "," + square_numbers +
                    "," + (ms % 3 == 0 ? "0.3" : "0.9") + "\n";
            text += std::to_string(t_us) + ",2,bar,OCCLUDED," + numbers(bar) + ",0.9\n";
        }
        folder_.file("poses.csv", text);
    }

    /// Around the corners of the square, and a few far from everything.
    void write_events() {
        std::vector<Event> events;
        for (int i = 0; i < 26'000; ++i) {
            const std::int64_t t_us = 50 * i;
            const auto place = square_at(static_cast<double>(t_us) * 1e-6);
            const double angle = place.theta + 0.785398 * (1 + 2 * (i % 4));
            const double radius = 12.7 * place.scale + i % 11 - 5;
            const auto px = [](double value) {
                return static_cast<std::uint16_t>(std::lround(value));
            };
            events.push_back(i % 13 == 0 ? Event{t_us, 200, 10, 1}
                                         : Event{t_us, px(place.x + radius * std::cos(angle)),
                                                 px(place.y + radius * std::sin(angle)), 1});
        }
        auto writer = sensor::create_dat(path("events.dat"), {304, 240});
        if (!writer || !(*writer)->write(events) || !(*writer)->close()) std::abort();
    }

    test::TemporaryFolder folder_;
};

}  // namespace pursuit::ctl
