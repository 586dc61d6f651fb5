// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "services/tracker/core/call_result.hpp"
#include "services/tracker/core/registration.hpp"

namespace pursuit::tracker {

/// What is registered and which constants hold, checked; knows no event. Every call changes all of
/// what it names or, on a refusal, nothing.
class Registry {
 public:
    Registry(std::uint32_t max_objects, std::uint32_t next_object_id, const Preset& preset);

    CallResult<Registered> add(const Registration& registration, std::int64_t effective_time_us);
    CallResult<const RegisteredObject*> replace(const ObjectUpdate& update,
                                                std::int64_t effective_time_us);
    CallResult<std::uint32_t> remove(std::string_view name);
    CallResult<const RegisteredObject*> set_start(std::string_view name, const Start& start,
                                                  std::int64_t effective_time_us);
    CallResult<void> set_strategy(StrategyKind kind, std::span<const NamedValue> parameters,
                                  std::int64_t effective_time_us);
    CallResult<void> set_parameters(std::string_view name, std::span<const NamedValue> parameters,
                                    std::int64_t effective_time_us);

    /// From now on nobody gets the id, until it is released: then who asks for it. Of an id that
    /// add() would have given.
    void reserve_id(std::uint32_t object_id);
    void release_id(std::uint32_t object_id);
    void take_ids_of(const Registry& other);

    [[nodiscard]] const RegisteredObject* find(std::string_view name) const;
    [[nodiscard]] const RegisteredObject* find(std::uint32_t object_id) const;
    [[nodiscard]] const std::vector<RegisteredObject>& objects() const { return objects_; }
    [[nodiscard]] const Settings& settings() const { return settings_; }
    [[nodiscard]] std::uint32_t next_object_id() const { return next_object_id_; }

 private:
    static constexpr std::uint32_t most_unused_ids = 1024;

    RegisteredObject* find_mutable(std::string_view name);
    void pass(std::uint32_t object_id);
    void keep_unused(std::uint32_t object_id);

    std::uint32_t max_objects_;
    std::uint32_t next_object_id_;
    std::uint32_t first_new_id_;        // ids below it are from before a restart …
    std::uint32_t restored_up_to_ = 0;  // … and come back by their number, in order
    // Below the next, and nobody has had them: passed over for a caller's choice, or released. The
    // highest are kept. A replay registers in order of time what was once numbered as it was asked.
    std::set<std::uint32_t> unused_ids_;
    std::set<std::uint32_t> reserved_ids_;
    StrategyParameters preset_strategy_;
    Settings settings_;
    std::vector<RegisteredObject> objects_;  // in order of ids
};

}  // namespace pursuit::tracker
