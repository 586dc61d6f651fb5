// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/registry.hpp"

#include <algorithm>
#include <string>

#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {
namespace {

tl::unexpected<CallError> refuse_unknown(std::string_view name) {
    return refuse(CallStatus::not_found,
                  "name: no object '" + std::string(name.substr(0, 64)) + "' is registered");
}

template <class Check>
CallResult<void> as_call_result(const Check& checked, const std::string& where) {
    if (checked) return {};
    return refuse(CallStatus::invalid_argument, where + checked.error().message);
}

CallResult<void> check_start(const Start& start, TransformKind transform) {
    if (start.search) return {};
    if (auto pose = as_call_result(check(start.pose, transform), "start."); !pose) return pose;
    return as_call_result(check(start.velocity), "start.");
}

/// The shape as the tracker keeps it: checked, and about its centre of gravity.
CallResult<Shape> accepted(const Shape& shape) {
    if (auto given = as_call_result(check(shape), "shape."); !given) {
        return tl::unexpected(given.error());
    }
    Shape moved = centred(shape);
    // Moving the origin may carry a point beyond the bound.
    if (auto kept = as_call_result(check(moved), "shape, about its centre of gravity: "); !kept) {
        return tl::unexpected(kept.error());
    }
    return moved;
}

CallResult<void> check_supported(EstimatorKind estimator) {
    if (estimator == EstimatorKind::gradient || estimator == EstimatorKind::kalman) return {};
    return refuse(CallStatus::invalid_argument, "estimator: not " + estimator_names());
}

CallResult<void> check_supported(StrategyKind strategy) {
    if (is_supported(strategy)) return {};
    return refuse(CallStatus::unsupported, "strategy: " + std::string(to_string(strategy)) +
                                               " is not built into this version");
}

Start allowed(const Start& start, TransformKind transform) {
    if (start.search) return {true, {}, {}};
    return {false, constrained(start.pose, transform), start.velocity};
}

}  // namespace

Registry::Registry(std::uint32_t max_objects, std::uint32_t next_object_id, const Preset& preset)
    : max_objects_(max_objects),
      next_object_id_(next_object_id),
      first_new_id_(next_object_id),
      preset_strategy_(preset.strategy_parameters) {
    settings_.strategy = preset.strategy;
    settings_.strategy_parameters = preset.strategy_parameters;
    settings_.tracker = preset.tracker;
    settings_.new_objects = preset.object;
}

CallResult<Registered> Registry::add(const Registration& registration,
                                     std::int64_t effective_time_us) {
    auto shape = accepted(registration.shape);
    if (!shape) return tl::unexpected(shape.error());
    if (auto estimator = check_supported(registration.estimator); !estimator) {
        return tl::unexpected(estimator.error());
    }
    if (auto start = check_start(registration.start, registration.transform); !start) {
        return tl::unexpected(start.error());
    }
    RegisteredObject object;
    object.parameters = settings_.new_objects;
    if (auto named = set(object.parameters, registration.parameters); !named) {
        return tl::unexpected(named.error());
    }
    const std::uint32_t wanted_id = registration.object_id;
    if (const RegisteredObject* there = find(shape->name)) {
        const bool identical =
            there->shape == *shape && there->transform == registration.transform &&
            there->estimator == registration.estimator && there->parameters == object.parameters &&
            (wanted_id == 0 || wanted_id == there->object_id);
        if (identical) return Registered{there->object_id, true};
        return refuse(CallStatus::already_exists,
                      "name: '" + shape->name + "' is registered as object " +
                          std::to_string(there->object_id) + " with other content");
    }
    const bool is_restored = wanted_id > restored_up_to_ && wanted_id < first_new_id_;
    const bool is_unused = unused_ids_.contains(wanted_id);
    if (wanted_id != 0 && wanted_id < next_object_id_ && !is_restored && !is_unused) {
        return refuse(CallStatus::already_exists, "object_id: " + std::to_string(wanted_id) +
                                                      " is or was in use; the next free one is " +
                                                      std::to_string(next_object_id_));
    }
    if (!is_restored && wanted_id > max_requested_id) {
        return refuse(CallStatus::invalid_argument,
                      "object_id: " + std::to_string(wanted_id) + " is above " +
                          std::to_string(max_requested_id) + ", the most that may be asked for");
    }
    if (!is_restored && !is_unused && next_object_id_ == no_object_id_left) {
        return refuse(CallStatus::limit_exceeded, "object_id: all ids were in use, none is left");
    }
    if (objects_.size() >= max_objects_) {
        return refuse(CallStatus::limit_exceeded, "objects: the table is full with " +
                                                      std::to_string(max_objects_) + " objects");
    }
    object.object_id = wanted_id != 0 ? wanted_id : next_object_id_;
    object.shape = std::move(*shape);
    object.effective_time_us = effective_time_us;
    object.transform = registration.transform;
    object.estimator = registration.estimator;
    object.start = allowed(registration.start, registration.transform);
    unused_ids_.erase(object.object_id);
    if (is_restored) {
        restored_up_to_ = wanted_id;
    } else {
        pass(object.object_id);
    }
    const Registered registered{object.object_id, false};
    const auto place = std::find_if(objects_.begin(), objects_.end(), [&](const auto& other) {
        return other.object_id > registered.object_id;
    });
    objects_.insert(place, std::move(object));
    return registered;
}

void Registry::pass(std::uint32_t object_id) {
    if (object_id < next_object_id_) return;
    const std::uint32_t over = std::min(object_id - next_object_id_, most_unused_ids);
    for (std::uint32_t id = object_id - over; id < object_id; ++id) keep_unused(id);
    next_object_id_ = object_id + 1;
}

void Registry::keep_unused(std::uint32_t object_id) {
    if (unused_ids_.size() >= most_unused_ids) unused_ids_.erase(unused_ids_.begin());
    unused_ids_.insert(object_id);
}

void Registry::reserve_id(std::uint32_t object_id) {
    unused_ids_.erase(object_id);
    pass(object_id);
    reserved_ids_.insert(object_id);
}

void Registry::release_id(std::uint32_t object_id) {
    if (reserved_ids_.erase(object_id) > 0) keep_unused(object_id);
}

void Registry::take_ids_of(const Registry& other) {
    first_new_id_ = other.first_new_id_;
    restored_up_to_ = other.restored_up_to_;
    unused_ids_ = other.unused_ids_;
    reserved_ids_ = other.reserved_ids_;
}

CallResult<const RegisteredObject*> Registry::replace(const ObjectUpdate& update,
                                                      std::int64_t effective_time_us) {
    auto shape = accepted(update.shape);
    if (!shape) return tl::unexpected(shape.error());
    RegisteredObject* object = find_mutable(shape->name);
    if (object == nullptr) return refuse_unknown(shape->name);
    if (auto estimator = check_supported(update.estimator); !estimator) {
        return tl::unexpected(estimator.error());
    }
    ObjectParameters parameters = object->parameters;
    if (auto named = set(parameters, update.parameters); !named) {
        return tl::unexpected(named.error());
    }
    object->shape = std::move(*shape);
    object->parameters = parameters;
    object->transform = update.transform;
    object->estimator = update.estimator;
    object->start = allowed(object->start, update.transform);
    object->effective_time_us = effective_time_us;
    return object;
}

CallResult<std::uint32_t> Registry::remove(std::string_view name) {
    const RegisteredObject* object = find(name);
    if (object == nullptr) return refuse_unknown(name);
    const std::uint32_t object_id = object->object_id;
    objects_.erase(objects_.begin() + (object - objects_.data()));
    return object_id;
}

CallResult<const RegisteredObject*> Registry::set_start(std::string_view name, const Start& start,
                                                        std::int64_t effective_time_us) {
    RegisteredObject* object = find_mutable(name);
    if (object == nullptr) return refuse_unknown(name);
    if (auto checked = check_start(start, object->transform); !checked) {
        return tl::unexpected(checked.error());
    }
    object->start = allowed(start, object->transform);
    object->effective_time_us = effective_time_us;
    return object;
}

CallResult<void> Registry::set_strategy(StrategyKind kind, std::span<const NamedValue> parameters,
                                        std::int64_t effective_time_us) {
    if (auto supported = check_supported(kind); !supported) return supported;
    StrategyParameters changed = preset_strategy_;
    if (auto named = set(changed, parameters); !named) return named;
    settings_.strategy = kind;
    settings_.strategy_parameters = changed;
    settings_.effective_time_us = effective_time_us;
    return {};
}

CallResult<void> Registry::set_parameters(std::string_view name,
                                          std::span<const NamedValue> parameters,
                                          std::int64_t effective_time_us) {
    if (!name.empty()) {
        RegisteredObject* object = find_mutable(name);
        if (object == nullptr) return refuse_unknown(name);
        auto changed = set(object->parameters, parameters);
        if (changed) object->effective_time_us = effective_time_us;
        return changed;
    }
    std::vector<NamedValue> of_objects;
    std::vector<NamedValue> of_tracker;
    for (const NamedValue& wanted : parameters) {
        const auto table = object_parameter_table();
        const bool is_of_objects = std::any_of(
            table.begin(), table.end(), [&](const auto& line) { return line.name == wanted.name; });
        (is_of_objects ? of_objects : of_tracker).push_back(wanted);
    }
    Settings changed = settings_;
    if (auto named = set(changed.tracker, of_tracker); !named) return named;
    if (auto named = set(changed.new_objects, of_objects); !named) return named;
    changed.effective_time_us = effective_time_us;
    settings_ = changed;
    if (of_objects.empty()) return {};
    for (RegisteredObject& object : objects_) {
        // Checked on the settings above: the same names and bounds.
        static_cast<void>(set(object.parameters, of_objects));
        object.effective_time_us = effective_time_us;
    }
    return {};
}

const RegisteredObject* Registry::find(std::string_view name) const {
    const auto found = std::find_if(objects_.begin(), objects_.end(),
                                    [&](const auto& object) { return object.shape.name == name; });
    return found == objects_.end() ? nullptr : &*found;
}

const RegisteredObject* Registry::find(std::uint32_t object_id) const {
    const auto found = std::find_if(objects_.begin(), objects_.end(), [&](const auto& object) {
        return object.object_id == object_id;
    });
    return found == objects_.end() ? nullptr : &*found;
}

RegisteredObject* Registry::find_mutable(std::string_view name) {
    return const_cast<RegisteredObject*>(std::as_const(*this).find(name));
}

}  // namespace pursuit::tracker
