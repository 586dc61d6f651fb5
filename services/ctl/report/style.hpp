// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pursuit::ctl {

/// The page's style sheet, light and dark.
extern const std::string_view report_style;

/// The page's script: the viewer over the strip of pictures. Without it the strip is shown alone.
extern const std::string_view report_script;

}  // namespace pursuit::ctl
