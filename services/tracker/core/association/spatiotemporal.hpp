// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/tracker/core/association/event_window.hpp"
#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {

/// The object in whose plane the event lies takes it, equation (3.14): the events of an object that
/// moves evenly lie, in (x, y, c·t), about a plane, which a principal component analysis over a
/// window finds; the event goes to the object whose plane is nearest.
///
/// Two readings, by StrategyParameters: the paper's distance in px or in units of the plane's own
/// spread; and planes fed with what their object takes, as in the paper, with every event near the
/// object, or with those near it alone. Fed with every event, where two objects cross for long each
/// plane becomes a little of the other's; fed with what it takes, the plane follows its own errors.
///
/// An object has a plane once its window was fed for its whole length; as long as one of the
/// objects asked has none, the closest takes the event. A window that ran empty begins anew.
///
/// The planes may also keep out events near one object alone that lie too far from its plane
/// (section 4.5), and, against a background that moves, ambiguous ones that lie too far from the
/// nearest (4.6).
///
/// Cost an event: constant on average; a plane is laid when an event asks for it and the last is
/// older than plane_refit_s. Memory: plane_events events an object.
class Spatiotemporal : public Strategy {
 public:
    explicit Spatiotemporal(const StrategyParameters& parameters) : parameters_(parameters) {}

    void near(const Event& event, std::span<const Claim> claims) override;
    [[nodiscard]] bool listens() const override { return true; }
    void assign(const Event& event, std::span<Claim> claims) override;
    void confirm(const Event& event, Claim& claim) override;
    void used(const Event& event, const Claim& claim) override;
    void forget(std::uint32_t object_id) override;
    void restart() override { objects_.clear(); }

 private:
    struct Object {
        std::uint32_t object_id = 0;
        EventWindow window;
        std::optional<Plane> plane;
    };

    void feed(const Event& event, std::uint32_t object_id);
    [[nodiscard]] Object* find(std::uint32_t object_id);
    /// To the object's plane, px or in its σ; nothing where it has none.
    std::optional<double> distance(const Event& event, std::uint32_t object_id);

    StrategyParameters parameters_;
    std::vector<Object> objects_;
};

}  // namespace pursuit::tracker
