// SPDX-License-Identifier: Apache-2.0
// pursuit-sensor: publishes the events of a recording or a scene.
#include "services/sensor/sensor_service.hpp"

int main(int argc, char** argv) {
    pursuit::disk::SensorConfig config;
    return pursuit::service_main(argc, argv, "pursuit-sensor", config, [&config] {
        return pursuit::sensor::SensorService::make(config);
    });
}
