// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "services/common/reader.hpp"
#include "services/common/topics.hpp"
#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/dds_options.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/json_text.hpp"
#include "services/ctl/newest_statuses.hpp"
#include "services/ctl/status_text.hpp"

namespace pursuit::ctl {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

/// Services find each other within this time on one host or network: while a kind is missing, it
/// is waited for so long.
constexpr auto settle_time = 1000ms;
constexpr auto poll_period = 10ms;

struct StatusOptions {
    DdsOptions dds;
    bool json = false;
    bool watch = false;
    bool wait_running = false;
};

/// NewestStatuses of one kind, as they come.
template <class Status>
class Statuses {
 public:
    Result<void> listen(Participant& participant, const char* topic_name) {
        auto made = Reader<Status>::create(
            participant, topic_name, [this](Status& status, const auto& info) {
                const std::scoped_lock lock(mutex_);
                newest_.put(status.instance().to_string(), status,
                            info.sample_identity.writer_guid(), SteadyClock::now());
            });
        if (!made) return tl::unexpected(made.error());
        reader_ = std::move(*made);
        return {};
    }
    /// Whether all who were found have told theirs.
    bool complete() {
        const std::scoped_lock lock(mutex_);
        return static_cast<int>(newest_.at(SteadyClock::now()).size()) >= reader_->matched();
    }
    std::map<std::string, Status> newest() {
        const std::scoped_lock lock(mutex_);
        return newest_.at(SteadyClock::now());
    }

 private:
    std::mutex mutex_;
    NewestStatuses<Status, eprosima::fastrtps::rtps::GUID_t> newest_;
    std::unique_ptr<Reader<Status>> reader_;
};

/// All three kinds at one time.
struct Overview {
    std::map<std::string, v1::SensorStatus> sensors;
    std::map<std::string, v1::TrackerStatus> trackers;
    std::map<std::string, v1::RecorderStatus> recorders;

    [[nodiscard]] std::size_t size() const {
        return sensors.size() + trackers.size() + recorders.size();
    }
    [[nodiscard]] bool has_every_kind() const {
        return !sensors.empty() && !trackers.empty() && !recorders.empty();
    }
    [[nodiscard]] bool all_running() const {
        const auto running = [](const auto& services) {
            return std::all_of(services.begin(), services.end(), [](const auto& entry) {
                return entry.second.health().state() == v1::SERVICE_RUNNING;
            });
        };
        return size() > 0 && running(sensors) && running(trackers) && running(recorders);
    }
};

class Listener {
 public:
    Result<void> listen(Participant& participant) {
        if (auto ok = sensors_.listen(participant, topic::sensor_status); !ok) return ok;
        if (auto ok = trackers_.listen(participant, topic::tracker_status); !ok) return ok;
        return recorders_.listen(participant, topic::recorder_status);
    }
    bool complete() { return sensors_.complete() && trackers_.complete() && recorders_.complete(); }
    Overview overview() { return {sensors_.newest(), trackers_.newest(), recorders_.newest()}; }

 private:
    Statuses<v1::SensorStatus> sensors_;
    Statuses<v1::TrackerStatus> trackers_;
    Statuses<v1::RecorderStatus> recorders_;
};

template <class Services>
void add_services(JsonObject& json, const std::string& kind, const Services& services) {
    // One of a kind is the common case, and easy to reach; all of them are beside it.
    json.raw(kind, services.empty() ? "null" : status_json(services.begin()->second));
    JsonObject all;
    for (const auto& [instance, status] : services) all.raw(instance, status_json(status));
    json.raw(kind + "s", all.text());
}

std::string text_of(const Overview& overview, bool json) {
    if (json) {
        JsonObject all;
        add_services(all, "sensor", overview.sensors);
        add_services(all, "tracker", overview.trackers);
        add_services(all, "recorder", overview.recorders);
        return all.text() + "\n";
    }
    std::string text;
    for (const auto& [instance, status] : overview.sensors) text += status_lines(status);
    for (const auto& [instance, status] : overview.trackers) text += status_lines(status);
    for (const auto& [instance, status] : overview.recorders) text += status_lines(status);
    return text;
}

int watch(Listener& listener, bool json) {
    const bool clear = !json && ::isatty(STDOUT_FILENO) == 1;
    for (;;) {
        const std::string text = (clear ? "\033[H\033[J" : "") + text_of(listener.overview(), json);
        if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) return exit_failure;
        std::this_thread::sleep_for(1s);
    }
}

int status(const StatusOptions& options) {
    auto participant = join(options.dds);
    if (!participant) return report(participant.error());
    Listener listener;
    if (auto ok = listener.listen(**participant); !ok) return report(ok.error());
    if (options.watch) return watch(listener, options.json);
    const auto begin = SteadyClock::now();
    const auto done = [&] {
        const auto overview = listener.overview();
        if (!listener.complete()) return false;
        if (options.wait_running && !overview.all_running()) return false;
        if (overview.has_every_kind()) return true;
        return overview.size() > 0 && SteadyClock::now() - begin > settle_time;
    };
    while (!done() && SteadyClock::now() - begin < options.dds.timeout()) {
        std::this_thread::sleep_for(poll_period);
    }
    const auto overview = listener.overview();
    if (overview.size() == 0) {
        return report(Error{"no service answers " + where(options.dds) + " within " +
                            std::to_string(options.dds.timeout_ms) + " ms"});
    }
    std::printf("%s", text_of(overview, options.json).c_str());
    if (options.wait_running && !overview.all_running()) {
        return report(Error{"not all services are running"});
    }
    return exit_success;
}

}  // namespace

Run define_status(CLI::App& app) {
    auto options = std::make_shared<StatusOptions>();
    add_dds_options(app, options->dds);
    app.add_flag("--json", options->json, "As one JSON object");
    app.add_flag(
        "--watch", options->watch,
        "Again every second, until interrupted; a service that is silent for 3 s is left out");
    app.add_flag("--wait-running", options->wait_running,
                 "Wait until every service that is there is RUNNING");
    return [options] { return status(*options); };
}

}  // namespace pursuit::ctl
