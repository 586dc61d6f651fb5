// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "services/sensor/filters/filter_chain.hpp"

namespace pursuit::sensor {

/// The filters in force: set by request from one thread, taken up by the thread that sends at its
/// next event. Making a chain (reading files, filling tables) holds up only the one who sets.
class FilterSwitch {
 public:
    /// As FilterChain::check().
    static Result<std::unique_ptr<FilterSwitch>> make(std::vector<FilterSetting> settings);

    /// Replaces the whole chain. An error names filter, parameter and bound; nothing has changed.
    Result<void> set(std::vector<FilterSetting> settings);

    /// A stream of this size begins: a fresh chain for it, without memory of the one before.
    Result<std::unique_ptr<FilterChain>> begin(Geometry input);

    /// The chain that set() has made since, or null.
    std::unique_ptr<FilterChain> take();

    /// "refractory, polarity", or empty.
    std::string names() const;

 private:
    explicit FilterSwitch(std::vector<FilterSetting> settings) : settings_(std::move(settings)) {}

    mutable std::mutex mutex_;
    std::vector<FilterSetting> settings_;
    Geometry input_;  // 0x0 before the first stream
    std::unique_ptr<FilterChain> next_;
    std::atomic<bool> changed_{false};
};

}  // namespace pursuit::sensor
