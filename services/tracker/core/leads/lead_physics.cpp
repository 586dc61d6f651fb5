// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/lead_physics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "services/tracker/core/leads/edge_passage.hpp"

namespace pursuit::tracker {
namespace {

// What there may be: contrast and threshold in log intensity, and the blur of the optics and of the
// pixel's own area together.
constexpr std::array contrasts = {0.9, 1.3, 1.7, 2.1, 2.6};
constexpr std::array thresholds = {0.13, 0.2, 0.3, 0.45, 0.65, 0.92};
constexpr std::array blurs_px = {0.48, 0.58, 0.72, 0.95};
constexpr double highest_threshold = 0.9;  // of the contrast: there are events
constexpr double usual_contrast = 1.8;
constexpr double contrast_sigma = 0.6;
constexpr double usual_threshold = 0.32;
constexpr double threshold_sigma = 0.4;  // of its logarithm
constexpr double usual_blur_px = 0.6;
constexpr double blur_sigma_px = 0.15;

// How long a pixel is blind is told from above mostly (Refractory), and jitter blurs it.
struct Blindness {
    double of_told;
    double prior;
};
constexpr std::array blindnesses = {Blindness{1.5, 0.4}, Blindness{1.2, 1},   Blindness{1, 1.5},
                                    Blindness{0.8, 1},   Blindness{0.5, 0.3}, Blindness{0.25, 0.1},
                                    Blindness{0.05, 0.2}};

// How well these pixels describe real ones.
constexpr double share_sigma = 0.06;
constexpr double between_sigma_px = 0.12;  // subsequent events and the first
constexpr double apart_sigma_px = 0.1;
// Below the first share nothing is told by subsequent events, from the second on all.
constexpr double least_share = 0.02;
constexpr double enough_share = 0.1;

// Ways that edges go while a pixel is blind, in units of the blur.
constexpr std::array blind_ways = {0.0, 0.1, 0.2, 0.35, 0.55, 0.8, 1.2, 1.8, 2.6, 3.8, 5.5, 8.0};

// The normal speeds of a contour that runs every way, beside its own speed. As long as it is, an
// edge makes events as fast as it moves across itself.
constexpr std::array normal_speeds = {0.2, 0.4, 0.6, 0.8, 1.0};

// Beside what fits at all, this weighs less than a millionth.
constexpr double hopeless = 60;

double squared(double x) { return x * x; }

/// What can be seen of the events of one sensor and edge, lengths in units of the blur.
struct Signs {
    double off_subsequent = 0;
    double on_subsequent = 0;
    double off_between = 0;  // first and subsequent
    double on_between = 0;
    double apart = 0;
    double common = 0;

    [[nodiscard]] Signs towards(const Signs& other, double u) const {
        const auto mix = [u](double from, double to) { return from + u * (to - from); };
        return {mix(off_subsequent, other.off_subsequent),
                mix(on_subsequent, other.on_subsequent),
                mix(off_between, other.off_between),
                mix(on_between, other.on_between),
                mix(apart, other.apart),
                mix(common, other.common)};
    }
};

struct Place {
    std::size_t before;
    double u;
};
Place place_of(double blind_way) {
    std::size_t i = 0;
    while (i + 2 < blind_ways.size() && blind_way > blind_ways[i + 1]) ++i;
    const double u = (blind_way - blind_ways[i]) / (blind_ways[i + 1] - blind_ways[i]);
    return {i, std::clamp(u, 0.0, 1.0)};
}

struct Hypothesis {
    double unusual;  // squared, in σ
    std::array<Signs, blind_ways.size()> signs;
};

std::vector<Hypothesis> make_hypotheses() {
    std::vector<Hypothesis> hypotheses;
    for (const double contrast : contrasts) {
        for (const double threshold : thresholds) {
            if (threshold > highest_threshold * contrast) continue;
            std::array<EdgePassage, blind_ways.size()> at{};
            for (std::size_t i = 0; i < at.size(); ++i) {
                at[i] = pass_edge(contrast, threshold, blind_ways[i]);
            }
            Hypothesis hypothesis{
                squared((contrast - usual_contrast) / contrast_sigma) +
                    squared(std::log(threshold / usual_threshold) / threshold_sigma),
                {}};
            for (std::size_t i = 0; i < at.size(); ++i) {
                EdgePassage all;
                for (const double speed : normal_speeds) {
                    const auto [before, u] = place_of(blind_ways[i] * speed);
                    for (const auto& [passage, part] :
                         {std::pair{&at[before], 1 - u}, std::pair{&at[before + 1], u}}) {
                        const Eigen::Vector4d events = speed * part * passage->events;
                        all.events += events;
                        all.ahead += events.cwiseProduct(passage->ahead);
                    }
                }
                all.ahead = all.ahead.cwiseQuotient(all.events.cwiseMax(1e-9));
                hypothesis.signs[i] = {all.subsequent_share(0),
                                       all.subsequent_share(1),
                                       all.ahead(0) - all.ahead(1),
                                       all.ahead(2) - all.ahead(3),
                                       all.apart(),
                                       all.common()};
            }
            hypotheses.push_back(hypothesis);
        }
    }
    return hypotheses;
}

const std::vector<Hypothesis>& all_hypotheses() {
    static const std::vector<Hypothesis> hypotheses = make_hypotheses();
    return hypotheses;
}

// Of two shares of subsequent events, how much what lies between them and the first ones tells.
double known(double seen_share, double told_share) {
    if (seen_share < least_share || told_share < least_share) return 0;
    return std::min(seen_share / enough_share, 1.0);
}

}  // namespace

void LeadPhysics::prepare() { static_cast<void>(all_hypotheses()); }

LeadPhysics::Told LeadPhysics::tell(const Seen& seen) {
    const std::vector<Hypothesis>& hypotheses = all_hypotheses();
    const Eigen::Vector4d& lead_px = seen.lead_px;
    const double off_between_px = lead_px(0) - lead_px(1);
    const double on_between_px = lead_px(2) - lead_px(3);
    const auto all_px = [&](int first, double subsequent) {
        return (1 - subsequent) * lead_px(first) + subsequent * lead_px(first + 1);
    };
    const double apart_px = all_px(2, seen.on_subsequent) - all_px(0, seen.off_subsequent);
    double sum = 0;
    double common = 0;
    double common2 = 0;
    double apart = 0;
    for (const double blur_px : blurs_px) {
        const double of_blur = squared((blur_px - usual_blur_px) / blur_sigma_px);
        for (const auto& [of_told, prior] : blindnesses) {
            const auto [before, u] = place_of(of_told * seen.blind_px / blur_px);
            for (const Hypothesis& hypothesis : hypotheses) {
                const Signs signs =
                    hypothesis.signs[before].towards(hypothesis.signs[before + 1], u);
                double misfit = of_blur + hypothesis.unusual;
                misfit += squared((seen.off_subsequent + seen.on_subsequent - signs.off_subsequent -
                                   signs.on_subsequent) /
                                  2 / share_sigma);
                misfit +=
                    known(seen.off_subsequent, signs.off_subsequent) *
                    squared((signs.off_between * blur_px - off_between_px) / between_sigma_px);
                misfit += known(seen.on_subsequent, signs.on_subsequent) *
                          squared((signs.on_between * blur_px - on_between_px) / between_sigma_px);
                if (seen.is_size_known) {
                    misfit += squared((signs.apart * blur_px - apart_px) / apart_sigma_px);
                }
                if (misfit > hopeless) continue;
                const double weight = prior * std::exp(-0.5 * misfit);
                sum += weight;
                common += weight * signs.common * blur_px;
                common2 += weight * squared(signs.common * blur_px);
                apart += weight * signs.apart * blur_px;
            }
        }
    }
    const double per_sum = 1 / std::max(sum, 1e-300);
    common *= per_sum;
    return {common, std::sqrt(std::max(common2 * per_sum - common * common, 0.0)), apart * per_sum};
}

}  // namespace pursuit::tracker
