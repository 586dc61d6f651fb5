// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "services/common/result.hpp"
#include "services/sensor/live/driver.h"
#include "services/sensor/live/live_input.hpp"

namespace pursuit::sensor {

/// A camera by its vendor's driver: a shared library, see driver.h. It stays loaded to the end of
/// the process, because its threads may outlive what they serve.
class DriverInput final : public LiveInput {
 public:
    /// Loads the library; refused where it cannot be, or is for another version.
    static Result<std::unique_ptr<DriverInput>> load(const std::string& path, std::string argument,
                                                     std::chrono::milliseconds longest_wait);

    void run(LiveSink& sink, const StopSignal& stop) override;

    /// As the driver calls itself.
    const std::string& name() const { return name_; }

 private:
    DriverInput(const pursuit_driver& driver, std::string argument,
                std::chrono::milliseconds longest_wait);

    const pursuit_driver& driver_;
    std::string name_;
    std::string argument_;
    std::chrono::milliseconds longest_wait_;
};

}  // namespace pursuit::sensor
