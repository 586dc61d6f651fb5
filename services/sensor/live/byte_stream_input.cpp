// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/byte_stream_input.hpp"

#include <utility>

namespace pursuit::sensor {
namespace {

constexpr std::size_t events_per_read = 8192;

}  // namespace

ByteStreamInput::ByteStreamInput(LiveAddress address, ReadOptions format,
                                 std::chrono::milliseconds longest_wait)
    : address_(std::move(address)),
      format_(std::move(format)),
      longest_wait_(longest_wait),
      events_(events_per_read),
      exposures_(events_per_read) {}

void ByteStreamInput::run(LiveSink& sink, const StopSignal& stop) {
    BackOff back_off(longest_wait_);
    sink.waits_for(address_.text);
    while (!stop.raised()) {
        auto source = connect_live(address_, stop);
        if (!source) {
            sink.waits_for(source.error().message);
        } else {
            sink.waits_for("bytes of " + address_.text);
            hear(std::move(*source), sink, stop);
            back_off.heard(sink.take_lasted());
            if (address_.kind == LiveAddress::Kind::standard_input) break;
        }
        stop.wait(-1, 0, back_off.next());
    }
}

void ByteStreamInput::hear(std::unique_ptr<ByteSource> source, LiveSink& sink,
                           const StopSignal& stop) {
    auto reader = open_events(std::move(source), format_);
    if (!reader) {
        // A peer that closes before it has sent anything is one that is not there yet.
        if (!stop.raised()) sink.waits_for(reader.error().message);
        return;
    }
    sink.begin((*reader)->geometry());
    std::string fault;
    std::uint64_t skipped = 0;
    for (;;) {
        const auto batch = (*reader)->read(events_, exposures_);
        sink.unusable((*reader)->events_skipped() -
                      std::exchange(skipped, (*reader)->events_skipped()));
        if (!batch) {
            if (!stop.raised()) fault = batch.error().message;
            break;
        }
        if (batch->at_end) break;
        sink.push(std::span(events_).first(batch->events),
                  std::span(exposures_).first(batch->exposures), (*reader)->time_us());
    }
    // Closed before anybody hears of the end: what is written next is of the next stream.
    reader->reset();
    sink.waits_for(fault.empty() ? address_.text : fault);
    sink.end(fault);
}

}  // namespace pursuit::sensor
