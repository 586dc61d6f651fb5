// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pursuit::tracker {

/// How strong the edges of a contour are beside each other, told by how many events each makes in a
/// pixel that it crosses, and what that does to where they come.
///
/// An edge that is w px wide and makes n events in a pixel makes them, were it even, at 1/n, 2/n …
/// n/n of its width: 1/n of them is the first one, and each comes w/n later than it would of an
/// edge without end. With the share s = 1 − 1/n of subsequent events all of them, first and
/// subsequent, come w·(s − s₀) earlier than those of an edge with share s₀; and w is twice what
/// lies between the first event's lead and the mean of the subsequent ones', whatever n. Leads that
/// all edges have in common therefore put the events of strong edges behind where they come, and
/// those of weak ones before: a van whose windows are stronger edges than its floor leans. (Real
/// edges are not even but blurred: three quarters of it is what fits.)
///
/// Where a pixel's refractory period keeps it from firing again, the share tells of speed and not
/// of contrast: it counts the less, the faster the object is.
class EdgeContrast {
 public:
    void restart(std::size_t pieces) {
        pieces_.assign(pieces, Counts{});
        usual_share_ = events_ = per_event_ = {};
        of_speed_ = of_width;
    }

    /// How much earlier the events of this piece come than those of the usual edge of a polarity
    /// (OFF 0, ON 1), beside what lies between its first and subsequent leads; nothing while little
    /// is known of it.
    [[nodiscard]] double earlier(std::int32_t piece, int polarity) const {
        const Counts& counts = pieces_[static_cast<std::size_t>(piece)];
        const double usual_share = usual_share_[static_cast<std::size_t>(polarity)];
        return of_speed_ * counts.per_event * (counts.subsequent - counts.events * usual_share);
    }

    /// The object is so fast now.
    void set_speed(double speed_px_s) {
        const double fast = speed_px_s / fast_px_s;
        of_speed_ = of_width / (1 + fast * fast);
    }

    /// An event of this piece that is the object's with probability `share`.
    [[gnu::always_inline]] void count(std::int32_t piece, int polarity, bool is_subsequent,
                                      double share) {
        const auto i = static_cast<std::size_t>(polarity);
        const auto subsequent = static_cast<double>(is_subsequent);
        if (events_[i] < most_events_of_all) {
            events_[i] += share;
            per_event_[i] = events_[i] > 0 ? 1 / events_[i] : 0;
        }
        usual_share_[i] += share * per_event_[i] * (subsequent - usual_share_[i]);
        Counts& counts = pieces_[static_cast<std::size_t>(piece)];
        counts.events += share;
        counts.subsequent += share * subsequent;
        if (counts.events >= most_events) {
            counts.events /= 2;
            counts.subsequent /= 2;
        }
        counts.per_event = 1 / (counts.events + few_events);
    }

 private:
    static constexpr double of_width = 1.5;
    static constexpr double fast_px_s = 300;
    static constexpr double few_events = 30;
    static constexpr double most_events = 1000;
    static constexpr double most_events_of_all = 10'000;

    struct Counts {
        double events = 0;
        double subsequent = 0;
        double per_event = 1 / few_events;
    };
    std::vector<Counts> pieces_;
    double of_speed_ = of_width;
    std::array<double, 2> usual_share_{};  // OFF, ON
    std::array<double, 2> events_{};
    std::array<double, 2> per_event_{};
};

}  // namespace pursuit::tracker
