// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/byte_stream_input.hpp"

#include <utility>

namespace pursuit::sensor {
namespace {

constexpr std::size_t events_per_read = 8192;

/// Tells whether anything came of a source.
class HeardSource final : public ByteSource {
 public:
    HeardSource(std::unique_ptr<ByteSource> source, bool& heard)
        : source_(std::move(source)), heard_(heard) {}

    const std::string& name() const override { return source_->name(); }

    Result<std::size_t> read(std::span<std::uint8_t> bytes) override {
        const auto n = source_->read(bytes);
        if (n && *n > 0) heard_ = true;
        return n;
    }

 private:
    std::unique_ptr<ByteSource> source_;
    bool& heard_;
};

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
    bool heard = false;
    auto reader = open_events(std::make_unique<HeardSource>(std::move(source), heard), format_);
    if (!reader) {
        if (stop.raised()) return;
        sink.waits_for(reader.error().message);
        // A peer that closes before it has sent anything is one that is not there yet; bytes that
        // make no beginning of a stream are a fault as those further on.
        if (heard) sink.end(reader.error().message);
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
