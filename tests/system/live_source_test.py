#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Live streams of bytes: TCP peers that send, stall, close, come late and flood; standard input.

The long run, by hand on a quiet machine:
    PURSUIT_TCP_SECONDS=20 PURSUIT_TCP_RATE=10000000 tests/system/live_source_test.py \\
        LiveSource.test_every_event_of_a_peer_arrives
"""

import os
import socket
import subprocess
import time
import unittest

import numpy

from pursuit_process import SystemTest, data, program

TIME_HIGH = numpy.uint32(8 << 28)
ON = numpy.uint32(1 << 28)


def evt2(begin_us, blocks, events_per_block):
    """Words of EVT2 from a multiple of 64 us on: each block is 64 us with its events spread over it."""
    words = numpy.empty((blocks, events_per_block + 1), numpy.uint32)
    words[:, 0] = TIME_HIGH | (numpy.arange(blocks, dtype=numpy.uint32) + begin_us // 64)
    i = numpy.arange(events_per_block, dtype=numpy.uint32)
    words[:, 1:] = ON | (i * 64 // max(events_per_block, 1)) << 22 | (i % 640) << 11 | (i * 7 % 480)
    return words


class Peer:
    """A camera's end of a TCP connection; the sensor connects to it."""

    def __init__(self, port=0):
        self.listener = socket.create_server(("127.0.0.1", port))
        self.listener.settimeout(10)
        self.port = self.listener.getsockname()[1]
        self.connection = None

    def accept(self):
        """Waits for the sensor; gives the seconds that it took."""
        begin = time.monotonic()
        if self.connection:
            self.connection.close()
        self.connection, _ = self.listener.accept()
        return time.monotonic() - begin

    def hang_up(self):
        self.connection.close()

    def close(self):
        if self.connection:
            self.connection.close()
        self.listener.close()


class LiveSource(SystemTest):
    def setUp(self):
        super().setUp()
        self.peer = Peer()

    def tearDown(self):
        self.peer.close()
        super().tearDown()

    def live(self, **fields):
        """A sensor that hears the peer, in EVT2 of 640x480."""
        fields = {"live": f"tcp://127.0.0.1:{self.peer.port}", "live_format": "evt2",
                  "live_geometry": "640x480", **fields}
        return self.service("sensor", **fields)

    def sent(self, count, timeout=10):
        """Waits until the sensor has published as many events."""
        return self.eventually(
            lambda: (lambda s: s if s["events_out"] >= count else None)(self.status_of("sensor")),
            timeout, f"{count} events are published")

    def test_every_event_of_a_peer_arrives(self):
        seconds = float(os.environ.get("PURSUIT_TCP_SECONDS", 1.5))
        rate_hz = float(os.environ.get("PURSUIT_TCP_RATE", 1e6))
        self.service("tracker")
        # Few and large packets: what a busy host may hold up is the time that 64 of them cover.
        self.live(wait_for_subscribers=1, packet_us=4000, packet_events=8000)
        self.peer.accept()
        blocks, per_block = 16, round(rate_hz * 64e-6)
        words = evt2(64_000, blocks, per_block)
        chunk_s = blocks * 64e-6
        begin, latest_s = time.monotonic(), 0.0
        chunks = int(seconds / chunk_s)
        for i in range(chunks):
            due = begin + i * chunk_s
            now = time.monotonic()
            if due > now:
                time.sleep(due - now)
            latest_s = max(latest_s, now - due)
            self.peer.connection.sendall(words)
            words[:, 0] += numpy.uint32(blocks)
        took_s = time.monotonic() - begin
        count = chunks * blocks * per_block
        status = self.sent(count)
        heard = self.eventually(lambda: (lambda t: t if t["events_in"] >= count else None)(
            self.status_of("tracker")), what="the tracker has every event")
        print(f"{count} events in {took_s:.2f} s, {count / took_s / 1e6:.2f} M/s, "
              f"the peer at most {latest_s * 1e3:.1f} ms late; "
              f"{heard['gaps']} gaps, {status['events_dropped']} dropped")
        self.assertEqual((status["events_in"], status["events_out"]), (count, count))
        self.assertEqual(status["events_dropped"], 0)
        self.assertEqual((heard["events_in"], heard["gaps"], heard["packets_missed"]),
                         (count, 0, 0))

    def test_a_peer_that_stalls_is_waited_for_and_what_it_sent_is_not_held_back(self):
        self.live()
        self.peer.accept()
        self.peer.connection.sendall(evt2(64_000, 3, 10))
        status = self.sent(30)
        stream = status["stream_id"]
        self.eventually(lambda: "silent for" in self.status_of("sensor")["detail"],
                        what="the status tells of the silence")
        self.peer.connection.sendall(evt2(128_000, 3, 10))
        begin = time.monotonic()
        status = self.sent(60)
        print(f"published {time.monotonic() - begin:.2f} s after the peer went on")
        self.assertEqual(status["stream_id"], stream)
        self.assertEqual(status["errors"], 0)
        self.assertEqual(status["last_t_us"] // 1000, 128)

    def test_a_peer_that_closes_within_a_word_is_a_fault_and_its_successor_a_new_stream(self):
        self.service("tracker")
        self.live(wait_for_subscribers=1)
        self.peer.accept()
        self.peer.connection.sendall(evt2(64_000_000, 3, 10).tobytes() + b"ab")
        stream = self.sent(30)["stream_id"]
        self.peer.hang_up()
        took_s = self.peer.accept()
        print(f"connected again {took_s:.3f} s after the peer closed")
        # Its time begins again.
        self.peer.connection.sendall(evt2(0, 3, 10))
        status = self.sent(60)
        self.assertNotEqual(status["stream_id"], stream)
        self.assertEqual(status["events_in"], 60)
        self.assertEqual(status["errors"], 1)
        self.assertIn(f"tcp://127.0.0.1:{self.peer.port}: byte 132: ", status["last_error"])
        heard = self.eventually(lambda: (lambda t: t if t["events_in"] >= 60 else None)(
            self.status_of("tracker")), what="the tracker has the events of both streams")
        self.assertEqual((heard["gaps"], heard["stream_id"]), (0, status["stream_id"]))

    def test_a_peer_that_is_not_there_yet_is_found_within_a_second(self):
        port = self.peer.port
        self.peer.close()
        self.live()
        self.eventually(lambda: "Connection refused" in self.status_of("sensor")["detail"],
                        what="the status says what is waited for")
        self.assertEqual(self.status_of("sensor")["state"], "WAITING")
        self.peer = Peer(port)
        took_s = self.peer.accept()
        print(f"found after {took_s:.3f} s")
        self.assertLess(took_s, 1.0)
        self.peer.connection.sendall(evt2(0, 1, 10))
        self.assertEqual(self.sent(10)["state"], "RUNNING")

    def test_a_path_that_is_not_there_is_named_from_the_first_word_on(self):
        sensor = self.service("sensor", live=self.path("camera"), live_format="evt2",
                              live_geometry="640x480")
        self.assertEqual(sensor.stop(), 0)
        self.assertIn(f"ready: waiting for {self.path('camera')}", sensor.err())

    def test_a_flood_drops_the_oldest_counts_them_and_is_caught_up_with(self):
        # Small packets make a slow bus.
        self.service("tracker")
        self.live(packet_events=8, live_buffer_events=65536, wait_for_subscribers=1)
        self.peer.accept()
        flood = evt2(64_000, 10_000, 500)
        count = 5_000_000
        begin = time.monotonic()
        self.peer.connection.sendall(flood)
        flooded_s = time.monotonic() - begin
        at_end = time.monotonic()
        done = lambda s: s["events_in"] >= count and s["events_in"] == s["events_out"] + s["events_dropped"]
        status = self.eventually(
            lambda: (lambda s: s if done(s) else None)(self.status_of("sensor")), 20,
            what="everything is published or dropped")
        recovered_s = time.monotonic() - at_end
        print(f"{count / flooded_s / 1e6:.1f} M events/s for {flooded_s:.2f} s: "
              f"{status['events_out']} published, {status['events_dropped']} dropped, "
              f"caught up {recovered_s:.2f} s after")
        self.assertLess(recovered_s, 5)  # with what it takes to ask for the status
        self.assertEqual(status["events_in"], count)
        self.assertEqual(status["dropped_by"]["live.queue_full"], status["events_dropped"])
        self.assertGreater(status["events_dropped"], 0)
        # What is published to the end is the newest.
        self.assertGreaterEqual(status["last_t_us"], 64_000 + 10_000 * 64 - 64)
        # Afterwards all is as it was.
        self.peer.connection.sendall(evt2(2_000_000, 3, 10))
        later = self.sent(status["events_out"] + 30)
        self.assertEqual(later["events_dropped"], status["events_dropped"])
        self.assertEqual(later["stream_id"], status["stream_id"])

    def test_bytes_that_make_no_sense_end_the_stream_and_the_next_connection_is_good(self):
        self.live()
        self.peer.accept()
        self.peer.connection.sendall(evt2(64_000, 3, 10).tobytes() + b"\xff\xff\xff\x5f")
        self.peer.accept()  # the sensor hangs up, and calls again
        self.peer.connection.sendall(evt2(0, 3, 10))
        status = self.sent(60)
        self.assertEqual(status["errors"], 1)
        self.assertIn("byte 132: ", status["last_error"])

    def test_a_peer_that_sends_a_little_and_closes_is_called_more_and_more_seldom(self):
        self.live()
        self.peer.accept()
        begin = time.monotonic()
        for _ in range(6):
            self.peer.connection.sendall(evt2(64_000, 1, 10))
            self.peer.accept()  # after 10, 20, 40, 80, 160 and 320 ms
        self.assertGreater(time.monotonic() - begin, 0.6)

    def test_paused_it_drops_the_oldest_and_resumed_it_goes_on(self):
        self.live(live_buffer_events=65536)
        self.peer.accept()
        self.peer.connection.sendall(evt2(64_000, 1, 10))
        self.sent(10)
        self.ctl("sensor", "pause")
        self.ctl("sensor", "rate", 2, code=1)
        self.assertIn("its own pace", self.ctl_err)
        self.peer.connection.sendall(evt2(128_000, 1000, 100))
        time.sleep(0.5)
        self.assertEqual(self.status_of("sensor")["state"], "PAUSED")
        self.ctl("sensor", "resume")
        status = self.eventually(lambda: (lambda s: s if s["events_in"] >= 100_010 else None)(
            self.status_of("sensor")), what="the sensor goes on")
        status = self.eventually(lambda: (lambda s: s if s["events_out"] + s["events_dropped"] ==
                                          100_010 else None)(self.status_of("sensor")), what="all is sent")
        self.assertGreater(status["events_dropped"], 100_000 - 65536 - 8192 - 1)

    def test_standard_input_is_a_stream_to_its_end(self):
        with open(data("known_answers.tsv")) as file:
            known = [line.split("\t") for line in file.read().splitlines()]
        for name, form in (("decoders/evt3_sample.raw", "raw"), ("decoders/rendered_plane.es", "es")):
            count = next(int(line[1]) for line in known if line[0] == name)
            settings = [f"live_format={form}", "live=-", "exit_at_end=false",
                        f"dds.domain={self.domain.domain}", "dds.loopback_only=true",
                        "live_buffer_events=100000000"]
            arguments = [word for setting in settings for word in ("--set", setting)]
            with open(data(name), "rb") as events:
                sensor = subprocess.Popen([program("pursuit-sensor"), *arguments], stdin=events,
                                          stderr=subprocess.DEVNULL)
            try:
                status = self.eventually(
                    lambda: (lambda s: s if s and s["process_id"] == sensor.pid and
                             s["state"] == "FINISHED" else None)(self.status_of("sensor")),
                    what="standard input ends")
                self.assertEqual((status["events_in"], status["events_out"], status["errors"]),
                                 (count, count, 0))
            finally:
                sensor.terminate()
                self.assertEqual(sensor.wait(5), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
