// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/fault.hpp"

#include <utility>

namespace pursuit::recorder::mcap {
namespace {

constexpr std::size_t max_faults = 100;

}  // namespace

std::string_view name_of(Condition condition) {
    switch (condition) {
        case Condition::reading:
            return "not read to its end";
        case Condition::closed:
            return "closed cleanly";
        case Condition::not_closed:
            return "not closed";
        case Condition::cut:
            return "cut short";
        case Condition::damaged:
            return "damaged";
        case Condition::unreadable:
            return "unreadable";
    }
    return "";
}

std::string to_string(const Fault& fault, const std::string& file_name) {
    return file_name + ": byte " + std::to_string(fault.offset) + ": " + fault.cause;
}

void FaultLog::end(Fault fault) {
    condition_ = fault.condition;
    note(std::move(fault));
}

void FaultLog::note(Fault fault) {
    if (faults_.size() < max_faults) faults_.push_back(std::move(fault));
}

void FaultLog::damage(std::uint64_t offset, std::string cause) {
    Fault fault{Condition::damaged, offset, std::move(cause)};
    if (on_damage_ == OnDamage::stop) return end(std::move(fault));
    note(std::move(fault));
}

}  // namespace pursuit::recorder::mcap
