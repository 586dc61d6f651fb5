// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/association/arbiter.hpp"
#include "services/tracker/core/geometry/reach_map.hpp"
#include "services/tracker/core/life/track.hpp"
#include "services/tracker/core/occlusion.hpp"
#include "services/tracker/core/pixels/recent_pixels.hpp"
#include "services/tracker/core/pose_grid.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/seeker.hpp"
#include "services/tracker/core/tracker_counters.hpp"
#include "services/tracker/core/tracker_options.hpp"

namespace pursuit::tracker {

struct Preset;

/// Takes events in order of time, asks the tracks that are near whose each is, and lets it move
/// them; hands over the poses that are due. What is done from time to time (rounds, searches, who
/// covers whom) is done before the first event at or after its time.
///
/// A change from outside holds from the first event or grid time after the last processed time; it
/// waits for that, unless no event of the stream has come yet: then nothing is to be done before
/// it, and there is time.
///
/// Allocates nothing an event. Thread: the tracker's.
class EventLoop {
 public:
    /// A call's effect.
    using Change = std::function<void(EventLoop&)>;

    /// Changes that wait for the next event, in a silence.
    static constexpr std::size_t most_held_changes = 1024;

    EventLoop(const TrackerOptions& options, const Preset& preset);

    /// Event time begins anew.
    void begin_stream(Geometry geometry, std::uint64_t stream_id, std::int64_t first_t_us);
    void process(std::span<const Event> events, PoseSink& sink);
    /// No event before t_us will come any more.
    void advance(std::int64_t t_us, PoseSink& sink);

    /// Only where has_room().
    void hold(Change change);
    [[nodiscard]] bool has_room() const { return changes_.size() < most_held_changes; }

    // What a change may do.
    void add(const RegisteredObject& object, const TrackerParameters& tracker);
    void remove(std::uint32_t object_id);
    /// Null where there is none.
    [[nodiscard]] Track* find(std::uint32_t object_id);
    /// Whose events are, is told anew where the object is concerned, and it is looked for anew.
    void forget(std::uint32_t object_id);
    /// It takes this content, and is looked for by it.
    void replace(const RegisteredObject& object);
    void set_strategy(StrategyKind kind, const StrategyParameters& parameters) {
        arbiter_.set_strategy(kind, parameters);
    }
    void set_tells_occlusion(bool tells);

    [[nodiscard]] std::span<const Track> tracks() const { return tracks_; }
    [[nodiscard]] std::int64_t last_t_us() const { return last_t_us_; }
    [[nodiscard]] std::int64_t effective_time_us() const { return last_t_us_ + 1; }
    [[nodiscard]] Geometry geometry() const { return geometry_; }
    [[nodiscard]] std::uint64_t stream_id() const { return stream_id_; }
    [[nodiscard]] const TrackerCounters& counters() const { return counters_; }

 private:
    struct HeldChange {
        std::int64_t effective_time_us;
        Change apply;
    };

    void apply_changes();
    void reach(std::int64_t now_us, PoseSink& sink);
    void emit_before(std::int64_t end_us, PoseSink& sink);
    bool accepts(const Event& event);
    void wake(std::int64_t t_us);
    void process(const Event& event, PoseSink& sink);
    const Approach* approach(const Event& event, std::size_t index, const PixelPast& past);
    bool step(const Event& event, std::size_t index, double weight, PoseSink& sink);
    void go_round(std::int64_t t_us);
    void restart_round();

    bool emits_updates_;
    PoseGrid grid_;
    TrackerCounters counters_;
    Geometry geometry_;
    std::uint64_t stream_id_ = 0;
    std::int64_t last_t_us_ = -1;
    std::deque<HeldChange> changes_;
    RecentPixels recent_;
    Arbiter arbiter_;
    std::vector<Track> tracks_;  // in order of ids
    bool tells_occlusion_;
    Occlusion occlusion_;
    Seeker seeker_;
    ReachMap reach_map_;
    std::int64_t next_round_us_ = 0;
    std::int64_t wake_us_ = 0;  // not before it is there anything to do but to take events
};

}  // namespace pursuit::tracker
