// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/edge_passage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pursuit::tracker {
namespace {

// The light of a dark shape that goes away over a pixel and comes back, dark 0 … bright 1.
constexpr double first_way = -4.5;  // before it no light changes
constexpr int steps = 900;
constexpr double step_way = -2 * first_way / steps;

// Pixels differ in their thresholds, ON and OFF by themselves. Without that all would fire at the
// same places of an edge.
constexpr double mismatch = 0.035;
constexpr int pixels = 12;
constexpr int warming_passages = 2;  // in which they forget what they began with
constexpr int counted_passages = 2;
constexpr int most_events = 40;

class Light {
 public:
    Light() : shares_(steps + 1) {
        for (int i = 0; i <= steps; ++i) {
            shares_[static_cast<std::size_t>(i)] =
                0.5 * (1 + std::erf((first_way + i * step_way) / std::sqrt(2.0)));
        }
    }
    [[nodiscard]] double at(double way) const {
        const double x = std::clamp((way - first_way) / step_way, 0.0, steps - 1e-9);
        const auto i = static_cast<std::size_t>(x);
        return shares_[i] + (x - static_cast<double>(i)) * (shares_[i + 1] - shares_[i]);
    }
    [[nodiscard]] double way_to(double share) const {
        const auto after = std::lower_bound(shares_.begin() + 1, shares_.end() - 1, share);
        const double before = *(after - 1);
        const auto i = static_cast<double>(after - shares_.begin()) - 1;
        return first_way +
               step_way * (i + std::clamp((share - before) / (*after - before), 0.0, 1.0));
    }

 private:
    std::vector<double> shares_;
};

// A sequence that fills the unit interval evenly, spread as normal deviates.
double deviate(std::uint32_t i, double irrational) {
    const double u = std::fmod((i + 0.5) * irrational, 1.0);
    // Of the logistic distribution with σ 1: near enough.
    return std::log(u / (1 - u)) * 0.5513;
}

}  // namespace

double EdgePassage::subsequent_share(int polarity) const {
    const int first = 2 * polarity;
    return events(first + 1) / std::max(events(first) + events(first + 1), 1e-9);
}

double EdgePassage::ahead_of(int polarity) const {
    const int first = 2 * polarity;
    const double sum = events(first) * ahead(first) + events(first + 1) * ahead(first + 1);
    return sum / std::max(events(first) + events(first + 1), 1e-9);
}

EdgePassage pass_edge(double contrast, double threshold, double blind_way) {
    static const Light light;
    // Where the light has come so near to its end, no threshold is left to be crossed.
    constexpr double whole = 0.9995;
    const double dark = std::exp(-contrast);
    const double least = 0.3 * threshold;
    EdgePassage passage;
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        const double on = std::max(threshold + mismatch * deviate(pixel, 0.6180339887), least);
        const double off = std::max(threshold + mismatch * deviate(pixel, 0.4142135624), least);
        double reference = 0;  // log light; of the bright ground
        for (int i = 0; i < 2 * (warming_passages + counted_passages); ++i) {
            const bool brightens = i % 2 == 1;
            double way = first_way;
            for (int event = 0; event < most_events; ++event) {
                const double level = std::exp(brightens ? reference + on : reference - off);
                const double share = (brightens ? level - dark : 1 - level) / (1 - dark);
                if (share >= whole) break;
                way = std::max(way, light.way_to(share));
                if (i >= 2 * warming_passages) {
                    const int kind = (brightens ? 2 : 0) + (event > 0 ? 1 : 0);
                    passage.events(kind) += 1;
                    passage.ahead(kind) -= way;
                }
                way += blind_way;
                const double gone = light.at(way);
                reference = std::log(brightens ? dark + (1 - dark) * gone : 1 - (1 - dark) * gone);
            }
        }
    }
    passage.ahead = passage.events.array().max(1e-9).inverse() * passage.ahead.array();
    passage.events /= pixels * counted_passages;
    return passage;
}

}  // namespace pursuit::tracker
