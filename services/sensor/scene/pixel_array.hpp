// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene.pb.h"
#include "services/common/event.hpp"
#include "services/sensor/scene/exposures.hpp"
#include "services/sensor/scene/random.hpp"

namespace pursuit::sensor {

/// The pixels of a change detector (Lichtsteiner et al. 2008; Posch et al. 2011, the ATIS).
///
/// A pixel keeps a reference of ln(brightness). When ln(brightness) has risen by the pixel's ON
/// threshold, or fallen by its OFF threshold, it fires. Then it is blind for the refractory period,
/// at whose end its reference is what it sees.
///
///     waiting --crossing: event--> blind --refractory_us--> waiting, reference := now
///
/// Events are written with the time of the crossing, between two looks interpolated in
/// ln(brightness), plus latency and jitter; so they are not in order. Jitter is cut off at 4 sigma.
class PixelArray {
 public:
    PixelArray(Geometry geometry, const disk::SceneSensor& sensor, std::uint64_t seed,
               const std::vector<float>& brightness);

    /// The pixel sees `brightness` at `t_us`. Since its last look, or since `since_us` where that
    /// is later, it changed evenly in ln(brightness).
    void look(std::uint32_t index, std::int64_t since_us, std::int64_t t_us, float brightness,
              std::vector<Event>& events);

    /// Whether the pixel is blind until after `t_us`, so that looking at it then is in vain.
    bool blind_beyond(std::uint32_t index, std::int64_t t_us) const {
        return blind_until_us_[index] > t_us;
    }

    /// How far brightness may go from what it was at the last look until the pixel fires; 0 where
    /// that is not settled, because it is blind.
    float room(std::uint32_t index) const {
        const State& state = states_[index];
        return blind_until_us_[index] != never
                   ? 0
                   : std::min(state.on_level - state.seen, state.seen - state.off_level);
    }

    /// By pixel: until when it is blind; a time in the past where it is not.
    std::span<const std::int64_t> blind_until_us() const { return blind_until_us_; }

    /// Background noise up to `t_us`: events of pixels that see no change. They blind the pixel and
    /// set its reference like any other.
    void noise(std::int64_t t_us, std::vector<Event>& events);

    bool has_exposures() const { return exposures_.has_value(); }

    /// Appends the exposure measurements' crossings before `end_us`, of which all events must have
    /// been seen; Exposures::take().
    void take_exposures(std::int64_t end_us, std::vector<Event>& crossings) {
        if (exposures_) exposures_->take(end_us, crossings);
    }

    /// No event comes earlier than its crossing by more than this.
    std::int64_t greatest_lead_us() const;

 private:
    static constexpr std::int64_t never = INT64_MIN;

    struct State {
        std::int64_t look_us = 0;  // of the last look
        float seen = 0;            // brightness at the last look
        float on_level = 0;        // brightness that fires
        float off_level = 0;
        float on_factor = 0;  // level / reference
        float off_factor = 0;
    };

    /// A Poisson process over some pixels.
    struct NoiseSource {
        double rate_per_us = 0;
        double next_us = 0;
        std::vector<std::uint32_t> pixels;  // empty: all
    };

    static void set_reference(State& state, float brightness);
    void fire(std::uint32_t index, std::int64_t t_us, bool on, float brightness,
              std::vector<Event>& events);
    void run(NoiseSource& source, std::int64_t t_us, std::vector<Event>& events);

    Geometry geometry_;
    std::int64_t refractory_us_;
    double latency_us_;
    double jitter_us_;
    Random jitter_;
    Random noise_;
    std::vector<State> states_;
    std::vector<std::int64_t> blind_until_us_;  // never: its reference is set
    NoiseSource background_;
    NoiseSource hot_;
    std::optional<Exposures> exposures_;
};

}  // namespace pursuit::sensor
