// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/parameters.hpp"

namespace pursuit::tracker {

/// Which parts of KalmanEstimator are in use. All of them are as a rule; what each is good for
/// shows without it (tests/experiments, `parts`). Without all of them it is a plain filter:
/// constant noise, no leads, a constant density of clutter.
struct KalmanParts {
    explicit KalmanParts(const ObjectParameters& parameters)
        : event_clock(is_set(parameters.uses_event_clock)),
          pace(is_set(parameters.remembers_pace)),
          leads(is_set(parameters.uses_leads)),
          lead_physics(is_set(parameters.holds_leads)),
          trail(is_set(parameters.learns_trail)),
          contrast(is_set(parameters.tells_contrast)),
          polarity(is_set(parameters.tells_polarity)),
          levels(is_set(parameters.remembers_levels)),
          quiet_facings(is_set(parameters.hears_silence)),
          steadiness(is_set(parameters.learns_steadiness)),
          clutter(is_set(parameters.measures_clutter)),
          measurement_noise(is_set(parameters.adapts_noise)),
          noise_watch(is_set(parameters.watches_noise)),
          offsets(is_set(parameters.learns_offsets)),
          bend(is_set(parameters.learns_bend)) {}

    bool event_clock;    ///< EventClock: how fast the object can turn away. Else its own velocity.
    bool pace;           ///< Pace
    bool leads;          ///< Events come ahead of an edge. Else on it; then none of the next five.
    bool lead_physics;   ///< LeadPrior: leads are held to what pixels make. Else the events' alone.
    bool trail;          ///< Trail
    bool contrast;       ///< EdgeContrast
    bool polarity;       ///< EdgePolarity
    bool levels;         ///< PixelLevels
    bool quiet_facings;  ///< QuietFacings
    bool steadiness;     ///< Steadiness. Else it may always turn as usual.
    bool clutter;        ///< Clutter's density as measured. Else usual_clutter.
    bool measurement_noise;  ///< MeasurementNoise adapts.
    bool noise_watch;        ///< NoiseWatch
    bool offsets;            ///< ContourOffsets
    bool bend;               ///< Bend

    static constexpr double usual_clutter = 0.02;  ///< 1/px, beside 1 for the object's events.

 private:
    static bool is_set(double value) { return value >= 0.5; }
};

}  // namespace pursuit::tracker
