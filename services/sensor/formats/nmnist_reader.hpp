// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/sensor/formats/formats.hpp"

namespace pursuit::sensor {

/// The 40-bit events of N-MNIST and N-Caltech101 (Orchard et al. 2015): one byte of x, one of y,
/// one bit of polarity, 23 bits of time in us, the highest first. Nothing before them.
///
/// - y 240, below the ATIS's last row, is no event: it adds 8192 us to all times from there on.
/// - Time wraps at 2^23 us: it is unwrapped where it falls by more than half of that. A
///   rise by more than that after a wrap is what is late across it, and goes back.
/// - The file states no geometry: 34x34 (N-MNIST) where its first 13000 events fit, else ATIS,
///   304x240.
Result<std::unique_ptr<EventReader>> open_nmnist(ByteWindow bytes, const ReadOptions& options);

}  // namespace pursuit::sensor
