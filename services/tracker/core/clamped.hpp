// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#else
#include <algorithm>
#endif

namespace pursuit::tracker {

/// As std::clamp, for what lies now within its bounds and now beyond, event by event: by the
/// processor's minimum and maximum. gcc makes branches of std::clamp here and there, and one that
/// nobody can foresee costs an event more than a lookup does.
[[nodiscard, gnu::always_inline]] inline double clamped(double value, double low, double high) {
#ifdef __SSE2__
    const __m128d raised = _mm_max_sd(_mm_set_sd(value), _mm_set_sd(low));
    return _mm_cvtsd_f64(_mm_min_sd(raised, _mm_set_sd(high)));
#else
    return value > low ? std::min(value, high) : low;
#endif
}

/// The same without a lower bound.
[[nodiscard, gnu::always_inline]] inline double at_most(double value, double high) {
#ifdef __SSE2__
    return _mm_cvtsd_f64(_mm_min_sd(_mm_set_sd(value), _mm_set_sd(high)));
#else
    return std::min(value, high);
#endif
}

}  // namespace pursuit::tracker
