// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/scene/scene_simulator.hpp"

namespace pursuit::sensor {

/// A simulated scene as a source of events: the same ones for the same scene and seed, made while
/// they are read. A scene in which nothing happens for an hour of its time ends there, so that
/// reading always ends; one call passes over 0.1 s of silence at most, so that it returns soon.
class SceneReader final : public EventReader {
 public:
    SceneReader(const Scene& scene, std::uint64_t seed) : simulator_(scene, seed) {}

    Geometry geometry() const override { return simulator_.geometry(); }

    bool has_exposures() const override { return simulator_.has_exposures(); }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> exposures) override;

 private:
    /// What is left of a slice of time.
    struct Slice {
        std::vector<Event> events;
        std::size_t taken = 0;

        bool empty() const { return taken == events.size(); }
        const Event& front() const { return events[taken]; }
        void clear();
    };

    SceneSimulator simulator_;
    std::int64_t silent_since_us_ = 0;
    Slice events_;
    Slice exposures_;
};

/// The scene of a file, or of a built-in name.
Result<std::unique_ptr<EventReader>> open_scene(const std::string& scene, std::uint64_t seed);

}  // namespace pursuit::sensor
