// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace pursuit::sensor {

/// Random numbers of a scene. The standard fixes the engine bit for bit but not the distributions,
/// so those are written out here: the same seed draws the same scene with every standard library.
/// (Logarithm and cosine still come from the C library: its last bit may differ between platforms.)
class Random {
 public:
    /// `stream` separates uses of one seed, so that a new use does not shift the others.
    Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(mix(seed) ^ mix(~stream))) {}

    /// Evenly in [0, 1).
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Evenly in 0 … count-1; the bias is below count / 2^53.
    std::uint32_t index(std::uint32_t count) {
        return static_cast<std::uint32_t>(uniform() * static_cast<double>(count));
    }

    bool chance(double probability) { return uniform() < probability; }

    /// Normal with mean 0 and standard deviation 1 (Box and Muller's cosine branch).
    double normal() {
        const double radius = std::sqrt(-2 * std::log(1 - uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

    /// Time to the next event of a Poisson process of rate 1.
    double exponential() { return -std::log(1 - uniform()); }

 private:
    /// splitmix64: neighbouring seeds become unrelated ones.
    static std::uint64_t mix(std::uint64_t z) {
        z += 0x9e3779b97f4a7c15ULL;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }

    std::mt19937_64 engine_;
};

}  // namespace pursuit::sensor
