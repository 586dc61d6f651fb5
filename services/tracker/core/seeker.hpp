// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/life/track.hpp"
#include "services/tracker/core/occlusion.hpp"
#include "services/tracker/core/pixels/last_events.hpp"
#include "services/tracker/core/search/chase.hpp"
#include "services/tracker/core/search/fired_map.hpp"
#include "services/tracker/core/search/shape_search.hpp"
#include "services/tracker/core/supported_events.hpp"

namespace pursuit::tracker {

/// Looks for the objects whose place is not known, one after another, in the last events. What it
/// finds it offers to the track, which tries it. The work is spread over the events by their time,
/// so that it neither stalls them nor depends on how fast they are processed.
///
/// Keeps the last 16,384 events, and looks at those of the last 250 ms at most.
class Seeker {
 public:
    void restart(Geometry geometry);

    /// What was begun for this object is of no use any more: it is elsewhere, or another shape.
    void forget(std::uint32_t object_id) {
        if (object_id == object_id_) forget_search();
    }

    /// Every event.
    void see(const Event& event) {
        last_.see(event);
        chase_.see(event);
    }

    /// Before the first event at or after next_us() is given to a track.
    void work(std::int64_t t_us, std::span<Track> tracks, const Occlusion& occlusion) {
        if (t_us >= due_us_) go_on(t_us, tracks, occlusion);
    }
    [[nodiscard]] std::int64_t next_us() const { return due_us_; }

 private:
    /// What is looked at: how many times the events that a shape makes on a way of 2 px, how far
    /// back, and how long before an event a neighbour of it fired.
    struct Look {
        double times = 1;
        std::int64_t window_us = 0;
        std::int64_t neighbour_us = 0;
    };
    /// By turns. Where the shape is not alone, more are needed, and the first may be too few; what
    /// is slow makes enough of them only in a longer time.
    static constexpr std::array looks{Look{1, 40'000, 5'000}, Look{3, 40'000, 5'000},
                                      Look{9, 40'000, 5'000}, Look{9, 100'000, 12'500},
                                      Look{30, 250'000, 31'250}};
    static constexpr std::array looks_of_check{Look{1, 150'000, 5'000}, Look{0.3, 150'000, 5'000},
                                               Look{3, 150'000, 5'000}};

    void go_on(std::int64_t t_us, std::span<Track> tracks, const Occlusion& occlusion);
    void begin(std::int64_t t_us, std::span<Track> tracks, const Occlusion& occlusion);
    void forget_search();
    void end(std::int64_t t_us, Track& track);
    void go_on_chasing(std::int64_t t_us, Track& track);
    void find_nearby(std::int64_t t_us, Track& track);
    void end_check(std::int64_t t_us, Track& track);
    [[nodiscard]] double more_as_it_goes();
    /// Looks again near a pose, in the newest events.
    void look_again(std::int64_t t_us, const Track& track, SearchRange again);
    /// The last `count` events that have a neighbour in space and time, in reach of the range.
    void gather(std::int64_t t_us, const SearchRange& range, double radius_px, std::size_t count);
    [[nodiscard]] static std::size_t wanted_events(const Track& track, double times);

    Geometry geometry_;
    LastEvents last_;
    Chase chase_;
    bool is_chasing_ = false;  // what the search has found
    SupportedEvents gathered_;
    std::vector<SupportedEvents::Cover> over_;  // what is checked
    FiredMap map_;
    ShapeSearch search_;
    Look look_;
    bool is_check_ = false;
    Coast checked_;                // the track, when the gathered events came, …
    Coast own_;                    // … and when they were gathered
    std::optional<Coast> going_;   // how they were led on to where they would come now
    std::uint32_t object_id_ = 0;  // of the search that goes on; 0: none
    std::uint32_t last_object_id_ = 0;
    std::uint32_t attempt_ = 0;
    std::int64_t began_us_ = -1;  // the stream
    bool has_looked_ = false;     // since then
    std::int64_t in_vain_ = 0;    // searches since one found something
    std::int64_t due_us_ = 0;
    std::int64_t worked_us_ = 0;
};

}  // namespace pursuit::tracker
