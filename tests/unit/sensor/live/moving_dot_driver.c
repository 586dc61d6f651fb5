/* SPDX-License-Identifier: Apache-2.0 */
/* A driver as docs/live-sources.md shows one, for a camera that sees one moving dot. */
#include <sched.h>
#include <stdlib.h>
#include <string.h>

#include "services/sensor/live/driver.h"

static int run_badly(const pursuit_sink* sink) {
    const pursuit_event events[] = {
        {50, 1, 1, 1, {0}}, {40, 1, 1, 1, {0}},        {55, 320, 1, 1, {0}}, {55, 1, 240, 1, {0}},
        {55, 1, 1, 2, {0}}, {INT64_MAX, 1, 1, 1, {0}}, {60, 2, 2, 0, {0}}};
    sink->begin(sink->context, 320, 240);
    sink->events(sink->context, events, sizeof events / sizeof *events, INT64_MAX);
    sink->lost(sink->context, 11);
    return 7;
}

static int run_of_no_size(const pursuit_sink* sink) {
    const pursuit_event event = {1, 1, 1, 1, {0}};
    for (int i = 0; i < 3; ++i) sink->begin(sink->context, 0, 240);
    sink->events(sink->context, &event, 1, 1);
    return 7;
}

static int run(const char* argument, const pursuit_sink* sink) {
    if (strcmp(argument, "bad") == 0) return run_badly(sink);
    if (strcmp(argument, "no size") == 0) return run_of_no_size(sink);
    const long wanted = strncmp(argument, "events=", 7) == 0 ? atol(argument + 7) : 0;
    sink->begin(sink->context, 320, 240);
    for (long i = 0; i < wanted && !sink->stopping(sink->context); ++i) {
        const pursuit_event event = {100 * i, (uint16_t)(i % 320), 120, 1, {0}};
        sink->events(sink->context, &event, 1, event.t_us);
    }
    while (wanted == 0 && !sink->stopping(sink->context)) sched_yield();
    sink->end(sink->context, NULL);
    return 0;
}

static const pursuit_driver driver = {PURSUIT_DRIVER_VERSION, "moving dot", run};

const pursuit_driver* pursuit_driver_entry(void) { return &driver; }
