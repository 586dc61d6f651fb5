// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/call_result.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"
#include "services/tracker/core/tracker_counters.hpp"
#include "services/tracker/core/tracker_options.hpp"

namespace pursuit::tracker {

/// Follows known shapes in one stream of events.
///
///     auto tracker = Tracker::create(options);
///     tracker->begin_stream(geometry, stream_id);
///     tracker->register_object({…});
///     tracker->process(events, sink);
///
/// Time is the events' alone, and the same events and calls give the same records bit for bit:
///  - Poses lie on the grid k·1e6/pose_rate_hz µs. A record is the state after the last event
///    before its grid time, handed over as soon as an event at or after it, or advance() to it,
///    comes. How the events are cut into process() calls, and advance() calls in silence, change
///    nothing.
///  - A call is answered at once and holds for events (and grid times) from effective_time_us() on,
///    that is, after the last time processed. The getters show it at once.
///    In a silence 1024 calls wait; more are refused, and identical ones with them.
///  - Before the first event of a stream there are no records. Where no event at all comes, the
///    grid is kept for 1 s, then thinned to 10 Hz up to 60 s, then to 1 Hz up to an hour, and then
///    there are none until an event comes: a jump in time makes a second of the grid and 4130
///    records more an object at most.
///  - Beyond max_poses_per_s every object keeps an even share of the grid, thinned or not; the rest
///    is counted.
///
/// No allocation and no clock call per event. One thread at a time; calls never block.
class Tracker {
 public:
    /// Refuses options out of their range and an unknown preset.
    static CallResult<Tracker> create(const TrackerOptions& options);

    Tracker(Tracker&& other) noexcept;
    Tracker& operator=(Tracker&& other) noexcept;
    ~Tracker();

    /// A sensor started: event time begins anew. Poses are kept; every track that had one looks for
    /// its object around it. Before the first call the stream has no geometry and takes no event.
    /// The geometry is_usable(). No event comes before `first_t_us`: so far has gone on what a
    /// former run followed in this very stream.
    void begin_stream(Geometry geometry, std::uint64_t stream_id, std::int64_t first_t_us = 0);

    /// Takes events in order of time. Those outside the geometry or back in time are dropped and
    /// counted.
    void process(std::span<const Event> events, PoseSink& sink);

    /// No event before t_us will come any more: hands over the poses up to it. A time before
    /// last_t_us() does nothing.
    void advance(std::int64_t t_us, PoseSink& sink);

    /// The last event's or advance()'s time; -1 before the first of a stream.
    [[nodiscard]] std::int64_t last_t_us() const;

    /// From when a call made now holds: last_t_us() + 1.
    [[nodiscard]] std::int64_t effective_time_us() const;

    /// Content identical to what is registered under the name (shape, kinds, parameters; whatever
    /// the start) changes nothing and gives the id there. Refused: a bad shape, start or parameter,
    /// a name or id in use by other content, an id that was used before, a full table.
    CallResult<Registered> register_object(const Registration& registration);
    /// Nobody gets this id, which register_object() would give, before it is released; then who
    /// asks for it by number.
    void reserve_id(std::uint32_t object_id);
    void release_id(std::uint32_t object_id);
    /// Which ids are reserved, were passed over, or are still to be restored.
    void take_ids_of(const Tracker& other);
    CallResult<void> update_object(const ObjectUpdate& update);
    CallResult<void> remove_object(std::string_view name);

    /// The track begins anew at `start`.
    CallResult<void> set_pose(std::string_view name, const Start& start);

    /// The object was followed by a former run, as `last` says, in the stream of this id. Where
    /// that stream is the next to begin, and the object was TRACKING, it goes on from there; else
    /// it is looked for around there. Where it is registered to start stays. Refused: an id that is
    /// not registered, and a pose or velocity out of bounds.
    CallResult<void> resume(const TrackSnapshot& last, std::uint64_t stream_id);

    /// Switches the strategy; parameters not named get the preset's values.
    CallResult<void> set_strategy(StrategyKind kind, std::span<const NamedValue> parameters);

    /// With a name: that object's parameters. Without: the tracker's, or, for a name of the object
    /// parameters, those of every object and of new ones.
    CallResult<void> set_parameters(std::string_view name, std::span<const NamedValue> parameters);

    /// In order of ids.
    [[nodiscard]] std::vector<std::string> object_names() const;
    [[nodiscard]] std::vector<RegisteredObject> objects() const;
    [[nodiscard]] CallResult<RegisteredObject> object(std::string_view name) const;
    [[nodiscard]] std::vector<TrackSnapshot> snapshots() const;
    [[nodiscard]] Settings settings() const;

    [[nodiscard]] const TrackerOptions& options() const;
    [[nodiscard]] Geometry geometry() const;
    [[nodiscard]] std::uint64_t stream_id() const;
    [[nodiscard]] std::uint32_t next_object_id() const;  ///< For TrackerOptions after a restart.
    [[nodiscard]] const TrackerCounters& counters() const;

 private:
    struct Impl;
    explicit Tracker(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace pursuit::tracker
