// SPDX-License-Identifier: Apache-2.0
// pursuit-tracker: follows known shapes in the events of one sensor.
#include "services/tracker/tracker_service.hpp"

int main(int argc, char** argv) {
    pursuit::disk::TrackerConfig config;
    return pursuit::service_main(argc, argv, "pursuit-tracker", config, [&config] {
        return pursuit::tracker::TrackerService::make(config);
    });
}
