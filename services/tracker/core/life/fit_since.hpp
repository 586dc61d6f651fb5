// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pursuit::tracker {

/// Whether the events since a moment fit as they do usually: of those within the gate, how many lie
/// on the contour, beside the usual share of them. What is put in an object's place makes as many
/// events as it did, some of them where its edges run along the object's.
class FitSince {
 public:
    void restart() { *this = FitSince(); }

    /// Some events within the gate, so many of them on the contour, where usually this share is.
    void count(int sharp, int astray, double usual_share) {
        const double wanted_share = nearly_usual * usual_share;
        const double all = sharp + astray;
        missing_ += wanted_share * all - sharp;
        variance_ += wanted_share * (1 - wanted_share) * all;
    }

    /// Nothing speaks against it, …
    [[nodiscard]] bool is_as_usual() const { return missing_ <= 0; }
    /// … or more than chance does; between the two nothing is told.
    [[nodiscard]] bool is_against() const {
        return missing_ > 0 && missing_ * missing_ > beyond_chance * beyond_chance * variance_;
    }

 private:
    // Half way to where an object is let go, as in Health. (Of what another shape makes in the
    // place of a star, a third to a half of the usual share lies on the star's contour.)
    static constexpr double nearly_usual = 0.75;
    static constexpr double beyond_chance = 3;  // σ

    double missing_ = 0;
    double variance_ = 0;
};

}  // namespace pursuit::tracker
