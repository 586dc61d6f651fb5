// SPDX-License-Identifier: Apache-2.0
#include "config.pb.h"
#include "services/common/service_main.hpp"
#include "services/recorder/recorder_service.hpp"

int main(int argc, char** argv) {
    pursuit::disk::RecorderConfig configuration;
    return pursuit::service_main(argc, argv, "pursuit-recorder", configuration, [&] {
        return pursuit::recorder::RecorderService::make(configuration);
    });
}
