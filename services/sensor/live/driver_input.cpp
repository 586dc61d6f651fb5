// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/driver_input.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace pursuit::sensor {
namespace {

constexpr std::uint16_t most_rows = 32768;

/// One call of run(): what it hands over is checked and goes on to the sink.
class Run {
 public:
    Run(LiveSink& sink, const StopSignal& stop, const std::string& driver)
        : sink_(sink), stop_(stop), driver_(driver) {}

    pursuit_sink functions() {
        return {this,
                [](void* run, std::uint16_t width, std::uint16_t height) {
                    self(run).begin({width, height});
                },
                [](void* run, const pursuit_event* events, std::size_t count, std::int64_t t_us) {
                    self(run).push({events, count}, false, t_us);
                },
                [](void* run, const pursuit_event* events, std::size_t count, std::int64_t t_us) {
                    self(run).push({events, count}, true, t_us);
                },
                [](void* run, std::uint64_t events) { self(run).sink_.lost_before(events); },
                [](void* run, const char* fault) { self(run).end(fault == nullptr ? "" : fault); },
                [](void* run) { return self(run).stop_.raised() ? 1 : 0; }};
    }

    void end(const std::string& fault) {
        if (std::exchange(in_stream_, false)) sink_.end(stop_.raised() ? "" : fault);
    }

 private:
    static Run& self(void* run) { return *static_cast<Run*>(run); }

    void begin(Geometry geometry) {
        end("");
        if (geometry.width == 0 || geometry.height == 0 || geometry.height > most_rows) {
            if (std::exchange(told_of_size_, true)) return;
            sink_.end("the driver " + driver_ + " begins a stream of " +
                      std::to_string(geometry.width) + "x" + std::to_string(geometry.height) +
                      " pixels, must be 1x1 to 65535x" + std::to_string(most_rows));
            return;
        }
        told_of_size_ = false;
        in_stream_ = true;
        geometry_ = geometry;
        reached_us_ = 0;
        sink_.begin(geometry);
    }

    void push(std::span<const pursuit_event> given, bool exposures, std::int64_t reached_us) {
        if (!in_stream_) {
            sink_.unusable(given.size());
            return;
        }
        good_.clear();
        for (const auto& e : given) {
            const bool good = e.t_us >= reached_us_ && e.t_us < max_t_us && e.x < geometry_.width &&
                              e.y < geometry_.height && e.polarity <= 1;
            if (!good) continue;
            good_.push_back({e.t_us, e.x, e.y, e.polarity});
            reached_us_ = e.t_us;
        }
        sink_.unusable(given.size() - good_.size());
        if (reached_us < max_t_us) reached_us_ = std::max(reached_us_, reached_us);
        const std::span<const Event> none;
        sink_.push(exposures ? none : good_, exposures ? good_ : none, reached_us_);
    }

    LiveSink& sink_;
    const StopSignal& stop_;
    const std::string& driver_;
    bool in_stream_ = false;
    bool told_of_size_ = false;
    Geometry geometry_;
    std::int64_t reached_us_ = 0;
    std::vector<Event> good_;
};

}  // namespace

DriverInput::DriverInput(const pursuit_driver& driver, std::string argument,
                         std::chrono::milliseconds longest_wait)
    : driver_(driver),
      name_(driver.name == nullptr ? "" : driver.name),
      argument_(std::move(argument)),
      longest_wait_(longest_wait) {}

Result<std::unique_ptr<DriverInput>> DriverInput::load(const std::string& path,
                                                       std::string argument,
                                                       std::chrono::milliseconds longest_wait) {
    void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) return fail_field("driver", ": " + std::string(::dlerror()));
    const auto entry =
        reinterpret_cast<const pursuit_driver* (*)()>(::dlsym(library, "pursuit_driver_entry"));
    if (entry == nullptr) {
        return fail_field("driver", ": " + path + ": has no pursuit_driver_entry()");
    }
    const auto* driver = entry();
    if (driver == nullptr || driver->version != PURSUIT_DRIVER_VERSION || driver->run == nullptr) {
        return fail_field("driver", ": " + path + ": is for version " +
                                        std::to_string(driver == nullptr ? 0 : driver->version) +
                                        " of driver.h, this sensor has version " +
                                        std::to_string(PURSUIT_DRIVER_VERSION));
    }
    return std::unique_ptr<DriverInput>(
        new DriverInput(*driver, std::move(argument), longest_wait));
}

void DriverInput::run(LiveSink& sink, const StopSignal& stop) {
    BackOff back_off(longest_wait_);
    while (!stop.raised()) {
        sink.waits_for("the driver " + name_);
        Run run(sink, stop, name_);
        const auto functions = run.functions();
        const int fault = driver_.run(argument_.c_str(), &functions);
        const std::string what =
            fault == 0 ? "" : "the driver " + name_ + " gave up with " + std::to_string(fault);
        run.end(what);
        if (fault == 0) return;
        sink.waits_for(what);
        back_off.heard(sink.take_lasted());
        stop.wait(-1, 0, back_off.next());
    }
}

}  // namespace pursuit::sensor
