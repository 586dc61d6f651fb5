// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/search/fired_map.hpp"
#include "services/tracker/core/search/search_range.hpp"

namespace pursuit::tracker {

/// The first pass of a search: every pose of a grid over the range, by a few points of the contour.
/// What speaks for one is that they lie nearer to what fired than its surroundings do, in standard
/// deviations. Keeps the best 16, apart from each other.
///
/// For each scale it is told first where so much fired that a pose can be there; then every turn
/// is looked at in all of these places.
class CoarseSearch {
 public:
    static constexpr int points = 24;

    CoarseSearch() = default;
    /// samples: so many points, at equal distances along a contour of this length and radius.
    CoarseSearch(const std::vector<Eigen::Vector2d>& samples_px, double radius_px,
                 double length_px);

    /// The map must stay as it is until is_done().
    void begin(const FiredMap& map, const SearchRange& range);

    /// Looks at more poses while any are left of this number, and takes from it what it has done.
    void step(int& poses);
    [[nodiscard]] bool is_done() const { return turn_ == turns_.size(); }

    /// The best, from the first on.
    [[nodiscard]] std::size_t count() const { return best_.size(); }
    [[nodiscard]] Pose pose(std::size_t i) const;

 private:
    static constexpr std::size_t kept = 16;

    struct Turn {
        double angle_rad = 0;
        double scale = 1;
        std::array<int, points> offset{};  // of each point, in near_
    };
    /// Where a pose may be, cells, and what fired around it.
    struct Spot {
        int column = 0;
        int row = 0;
        double mean = 0;
        double deviation = 0;
    };
    struct Candidate {
        double z = 0;
        std::size_t turn = 0;
        int column = 0;
        int row = 0;
    };

    void lay_out_turns(const SearchRange& range);
    void copy_near();
    void find_spots_in_row();
    void look_at(const Turn& turn, const Spot& spot);
    void keep(const Candidate& candidate);

    std::vector<Eigen::Vector2d> samples_px_;  // model frame; in an order that tells soon
    double radius_px_ = 0;
    double length_px_ = 0;

    const FiredMap* map_ = nullptr;
    std::vector<Turn> turns_;  // all of a scale together
    // The map, as far as the contour reaches from any of the places.
    std::vector<std::uint8_t> near_;
    int margin_columns_ = 0, margin_rows_ = 0;
    int near_columns_ = 0;
    // The places, cells.
    int first_column_ = 0, end_column_ = 0;
    int first_row_ = 0, end_row_ = 0;
    int stride_ = 3;

    std::vector<Spot> spots_;  // of the scale in hand, in the rows before row_
    int row_ = 0;
    std::size_t turn_ = 0;
    std::size_t spot_ = 0;
    std::vector<Candidate> best_;  // falling z
};

}  // namespace pursuit::tracker
