// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/pixel_array.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
namespace {

constexpr std::uint64_t threshold_stream = 10;
constexpr std::uint64_t jitter_stream = 11;
constexpr std::uint64_t noise_stream = 12;

/// No threshold is below this share of the mean one: the tail of the mismatch would fire for ever.
constexpr double least_threshold_share = 0.3;

constexpr double jitter_cut = 4;

}  // namespace

PixelArray::PixelArray(Geometry geometry, const disk::SceneSensor& sensor, std::uint64_t seed,
                       const std::vector<float>& brightness)
    : geometry_(geometry),
      refractory_us_(sensor.refractory_us()),
      latency_us_(sensor.latency_us()),
      jitter_us_(sensor.jitter_us()),
      jitter_(seed, jitter_stream),
      noise_(seed, noise_stream),
      states_(brightness.size()),
      blind_until_us_(brightness.size(), never) {
    if (sensor.exposure_us() > 0) exposures_.emplace(geometry, sensor.exposure_us());
    Random thresholds(seed, threshold_stream);
    const double mean = sensor.threshold();
    const auto threshold = [&] {
        const double drawn = mean + sensor.mismatch() * thresholds.normal();
        return std::max(drawn, least_threshold_share * mean);
    };
    for (std::size_t i = 0; i < states_.size(); ++i) {
        states_[i].on_factor = static_cast<float>(std::exp(threshold()));
        states_[i].off_factor = static_cast<float>(std::exp(-threshold()));
        states_[i].seen = brightness[i];
        set_reference(states_[i], brightness[i]);
    }
    const auto count = static_cast<std::uint32_t>(states_.size());
    background_.rate_per_us = sensor.noise_hz() * count / 1e6;
    for (std::uint32_t i = 0; i < sensor.hot_pixels(); ++i) {
        hot_.pixels.push_back(noise_.index(count));
    }
    hot_.rate_per_us = sensor.hot_hz() * static_cast<double>(hot_.pixels.size()) / 1e6;
    for (auto* source : {&background_, &hot_}) {
        if (source->rate_per_us > 0) source->next_us = noise_.exponential() / source->rate_per_us;
    }
}

void PixelArray::set_reference(State& state, float brightness) {
    state.on_level = brightness * state.on_factor;
    state.off_level = brightness * state.off_factor;
}

std::int64_t PixelArray::greatest_lead_us() const {
    return static_cast<std::int64_t>(std::ceil(jitter_cut * jitter_us_ - latency_us_)) + 1;
}

void PixelArray::fire(std::uint32_t index, std::int64_t t_us, bool on, float brightness,
                      std::vector<Event>& events) {
    const double jitter =
        jitter_us_ > 0 ? jitter_us_ * std::clamp(jitter_.normal(), -jitter_cut, jitter_cut) : 0;
    const std::int64_t stamp = t_us + std::llround(latency_us_ + jitter);
    events.push_back({std::max<std::int64_t>(stamp, 0),
                      static_cast<std::uint16_t>(index % geometry_.width),
                      static_cast<std::uint16_t>(index / geometry_.width),
                      static_cast<std::uint8_t>(on ? 1 : 0)});
    blind_until_us_[index] = t_us + refractory_us_;
    if (exposures_) exposures_->start(index, t_us + std::llround(latency_us_), brightness);
}

void PixelArray::look(std::uint32_t index, std::int64_t since_us, std::int64_t t_us,
                      float brightness, std::vector<Event>& events) {
    State& state = states_[index];
    std::int64_t& blind_until_us = blind_until_us_[index];
    std::int64_t from_us = std::max(state.look_us, since_us);
    float before = state.seen;
    // Its blindness ended unseen: no edge was near any more, so that what it sees now is what it
    // saw then.
    if (state.look_us < blind_until_us && blind_until_us <= since_us) before = brightness;
    state.look_us = t_us;
    state.seen = brightness;
    for (;;) {
        if (blind_until_us != never) {
            if (blind_until_us > t_us) return;
            if (blind_until_us > from_us) {
                const float u = static_cast<float>(blind_until_us - from_us) /
                                static_cast<float>(t_us - from_us);
                before *= std::pow(brightness / before, u);
                from_us = blind_until_us;
            }
            set_reference(state, before);
            blind_until_us = never;
        }
        const bool on = brightness >= state.on_level;
        if (!on && brightness > state.off_level) return;
        const float level = on ? state.on_level : state.off_level;
        const float way = std::log(brightness / before);
        const float u = way == 0 ? 1.0F : std::clamp(std::log(level / before) / way, 0.0F, 1.0F);
        const auto crossing_us =
            from_us + static_cast<std::int64_t>(std::lround(static_cast<double>(u) *
                                                            static_cast<double>(t_us - from_us)));
        fire(index, crossing_us, on, level, events);
        before = level;
        from_us = crossing_us;
    }
}

void PixelArray::run(NoiseSource& source, std::int64_t t_us, std::vector<Event>& events) {
    if (source.rate_per_us <= 0) return;
    while (source.next_us < static_cast<double>(t_us)) {
        const auto now_us = static_cast<std::int64_t>(source.next_us);
        source.next_us += noise_.exponential() / source.rate_per_us;
        const auto index =
            source.pixels.empty()
                ? noise_.index(static_cast<std::uint32_t>(states_.size()))
                : source.pixels[noise_.index(static_cast<std::uint32_t>(source.pixels.size()))];
        const bool on = noise_.chance(0.5);
        if (blind_beyond(index, now_us)) continue;
        fire(index, now_us, on, states_[index].seen, events);
    }
}

void PixelArray::noise(std::int64_t t_us, std::vector<Event>& events) {
    run(background_, t_us, events);
    run(hot_, t_us, events);
}

}  // namespace pursuit::sensor
