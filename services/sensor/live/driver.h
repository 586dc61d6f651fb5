/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What a camera's driver implements to hand its events to pursuit-sensor: a shared library that
 * exports the one function pursuit_driver_entry(). This header is all it needs; it is C, so that
 * drivers are built by any compiler, apart from Pursuit. docs/live-sources.md has a whole example.
 *
 *     pursuit-sensor --set driver=/usr/lib/my_camera.so --set driver_argument="serial=42"
 */
#ifndef PURSUIT_DRIVER_H
#define PURSUIT_DRIVER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Changes when anything below does; a library for another version is refused. */
#define PURSUIT_DRIVER_VERSION 1

/* One brightness change, or one crossing of an ATIS exposure measurement. */
typedef struct pursuit_event {
    int64_t t_us;     /* sensor time, us, 0 .. 2^53-1; never decreases within a stream */
    uint16_t x;       /* px to the right, 0 .. width-1 */
    uint16_t y;       /* px downwards, 0 .. height-1 */
    uint8_t polarity; /* 1 brighter, 0 darker; of a measurement: 0 its begin, 1 its end */
    uint8_t unused[3];
} pursuit_event;

/*
 * Where events go. Call these from one thread at a time; none of them waits. A stream is begin(),
 * any number of events() and exposures(), and end(). What is handed over is copied.
 */
typedef struct pursuit_sink {
    void* context; /* the first argument of each */

    /* A stream begins, of this size: at most 65535 wide and 32768 high, or it is a fault. */
    void (*begin)(void* context, uint16_t width, uint16_t height);

    /*
     * Events in order of time, as soon as they are there, many or few. `reached_us`: nothing that
     * follows is earlier; where nothing happened for a while, tell the time with no events at all.
     * Events that break what is said above are left out and counted; such a time is passed over.
     */
    void (*events)(void* context, const pursuit_event* events, size_t count, int64_t reached_us);

    /* Measurements, likewise; no earlier than what was told before. */
    void (*exposures)(void* context, const pursuit_event* exposures, size_t count,
                      int64_t reached_us);

    /* So many events were lost before they came here: in the camera, on the bus, in the driver. */
    void (*lost)(void* context, uint64_t events);

    /* The stream has ended; `fault`: why it should not have, or NULL. */
    void (*end)(void* context, const char* fault);

    /* Not 0 when run() is to return, within 0.5 s. */
    int (*stopping)(void* context);
} pursuit_sink;

typedef struct pursuit_driver {
    uint32_t version; /* PURSUIT_DRIVER_VERSION */
    const char* name; /* for people */

    /*
     * Opens the camera and hands over its streams until sink->stopping(), or until it is unplugged.
     * Runs on a thread of its own. Returns 0 when the camera has no more to give: the sensor then
     * ends; anything else: a fault, and run() is called again, after 10 ms at first and at most
     * reconnect_ms. A stream that was not ended is ended by the return.
     */
    int (*run)(const char* argument, const pursuit_sink* sink);
} pursuit_driver;

/* The one thing that the library exports. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const pursuit_driver*
pursuit_driver_entry(void);

#ifdef __cplusplus
}
#endif

#endif
