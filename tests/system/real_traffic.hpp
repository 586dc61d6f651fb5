// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastrtps/xmlparser/XMLProfileManager.h>

namespace pursuit::testing {

/// Participants of one process talk over sockets, as those of two do; Fast DDS would pass samples
/// by function calls. Before the first participant of the process is made.
inline void deliver_over_sockets() {
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

}  // namespace pursuit::testing
