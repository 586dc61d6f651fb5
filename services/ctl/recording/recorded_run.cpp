// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/recording/recorded_run.hpp"

#include <algorithm>
#include <functional>

#include "services/common/topics.hpp"
#include "services/ctl/recording/cdr.hpp"
#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/replay/recorded_calls.hpp"
#include "services/sensor/packed_event.hpp"

namespace pursuit::ctl {
namespace {

namespace mcap = recorder::mcap;

constexpr std::size_t most_slice_events = 200'000;

using Take = std::function<void(const mcap::MessageView&)>;

/// Every good message of the file; faults are told, not returned, as what is before them is good.
Result<std::vector<std::string>> for_each_message(const std::string& path, const Take& take) {
    auto input = mcap::FileInput::open(path);
    if (!input) return tl::unexpected(input.error());
    auto reader = mcap::Reader::open(std::move(*input), path, {}, mcap::OnDamage::skip_chunk);
    if (!reader) return tl::unexpected(reader.error());
    for (;;) {
        auto message = reader->next();
        if (!message || !*message) break;
        if ((*message)->channel->message_encoding == mcap::message_encoding) take(**message);
    }
    std::vector<std::string> faults;
    for (const auto& fault : reader->faults()) faults.push_back(mcap::to_string(fault, path));
    return faults;
}

/// Numbers that go up by one; what is left out is counted.
class Sequence {
 public:
    std::uint64_t missing(std::uint64_t number) {
        const auto gap = next_ && number > *next_ ? number - *next_ : 0;
        next_ = std::max(number + 1, next_.value_or(0));
        return gap;
    }

 private:
    std::optional<std::uint64_t> next_;
};

class FirstPass {
 public:
    FirstPass(RecordedRun& run, std::size_t most_poses) : run_(run), most_poses_(most_poses) {}

    /// Poses of the last stream beyond the most that are kept.
    [[nodiscard]] std::size_t poses_left_out() const {
        return pose_count_ - std::min(pose_count_, most_poses_);
    }

    void take(const mcap::MessageView& message) {
        const auto& topic = message.channel->topic;
        if (topic == topic::events) {
            if (auto packet = decode_cdr<v1::EventPacket>(message.data)) events(*packet);
        } else if (topic == topic::poses) {
            if (auto pose = decode_cdr<v1::ObjectPose>(message.data)) take_pose(*pose);
        } else if (topic == topic::models) {
            if (auto model = decode_cdr<v1::RegisteredModel>(message.data)) {
                if (model->registered()) run_.models[model->object_id()] = std::move(*model);
            }
        } else if (topic == topic::tracker_settings) {
            if (auto settings = decode_cdr<v1::TrackerSettings>(message.data)) strategy(*settings);
        } else if (topic == topic::sensor_status) {
            if (auto status = decode_cdr<v1::SensorStatus>(message.data)) run_.sensor = *status;
        } else if (topic == topic::tracker_status) {
            if (auto status = decode_cdr<v1::TrackerStatus>(message.data)) run_.tracker = *status;
        } else if (topic == topic::recorder_status) {
            if (auto status = decode_cdr<v1::RecorderStatus>(message.data)) run_.recorder = *status;
        } else if (topic == topic::tracker_request) {
            if (auto request = decode_cdr<v1::TrackerRequest>(message.data)) {
                calls_.take(std::move(*request));
            }
        } else if (topic == topic::tracker_reply) {
            if (auto reply = decode_cdr<v1::TrackerReply>(message.data)) {
                calls_.take(std::move(*reply), 0);
            }
        }
    }

    /// Calls whose replies alone were recorded.
    [[nodiscard]] std::uint64_t calls_missing() const { return calls_.unasked(); }

 private:
    void events(const v1::EventPacket& packet) {
        if (packet.stream_id() != run_.stream_id) {
            run_.stream_id = packet.stream_id();
            run_.events_per_bin.clear();
            run_.poses.clear();
            run_.first_t_us.reset();
            packets_ = {};
            poses_.clear();
            pose_count_ = 0;
        }
        run_.geometry = {packet.width(), packet.height()};
        run_.packets_missing += packets_.missing(packet.sequence_number());
        ++run_.packets;
        run_.events += packet.words().size();
        if (!run_.first_t_us) run_.first_t_us = packet.base_time_us();
        run_.last_t_us = packet.base_time_us();
        if (!packet.words().empty()) {
            run_.last_t_us =
                packet.base_time_us() + static_cast<std::int64_t>(packet.words().back() >> 32);
        }
        const auto bin = packet.base_time_us() / RecordedRun::bin_us * RecordedRun::bin_us;
        run_.events_per_bin[bin] += packet.words().size();
    }

    void take_pose(const v1::ObjectPose& pose) {
        run_.poses_missing += poses_[pose.object_id()].missing(pose.sequence_number());
        if (++pose_count_ > most_poses_) return;
        run_.poses[pose.object_id()].push_back({pose.t_us(), pose.state(), pose.x_px(), pose.y_px(),
                                                pose.a00(), pose.a01(), pose.a10(), pose.a11(),
                                                pose.confidence()});
    }

    void strategy(const v1::TrackerSettings& settings) {
        static constexpr const char* names[] = {"closest",      "reject_all", "update_all",
                                                "weighted",     "temporal",   "spatiotemporal",
                                                "probabilistic"};
        if (settings.strategy() > v1::STRATEGY_PROBABILISTIC) return;
        const std::string name = names[settings.strategy()];
        if (!run_.strategies.empty() && run_.strategies.back().second == name) return;
        run_.strategies.emplace_back(settings.effective_time_us(), name);
    }

    RecordedRun& run_;
    recorder::RecordedCalls calls_;
    std::size_t most_poses_;
    Sequence packets_;
    std::map<std::uint32_t, Sequence> poses_;
    std::size_t pose_count_ = 0;
};

/// The ends of the slices: evenly over the time from the first pose to the last.
void place_slices(RecordedRun& run, std::size_t count, std::int64_t slice_us) {
    std::optional<std::int64_t> begin, end;
    for (const auto& [id, poses] : run.poses) {
        if (poses.empty()) continue;
        begin = std::min(begin.value_or(poses.front().t_us), poses.front().t_us);
        end = std::max(end.value_or(poses.back().t_us), poses.back().t_us);
    }
    if (!begin || count == 0) return;
    for (std::size_t i = 0; i < count; ++i) {
        const auto share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const auto at_us =
            *begin + static_cast<std::int64_t>(share * static_cast<double>(*end - *begin));
        run.slices.push_back({at_us - slice_us, at_us, {}});
    }
}

void fill_slices(RecordedRun& run, const v1::EventPacket& packet) {
    if (packet.stream_id() != run.stream_id || packet.words().empty()) return;
    const auto base_us = packet.base_time_us();
    const auto last_us = base_us + static_cast<std::int64_t>(packet.words().back() >> 32);
    for (auto& slice : run.slices) {
        if (last_us < slice.begin_us || base_us >= slice.end_us) continue;
        for (const auto word : packet.words()) {
            const auto event = sensor::unpack(word, base_us);
            if (event.t_us >= slice.begin_us && event.t_us < slice.end_us &&
                slice.events.size() < most_slice_events) {
                slice.events.push_back(event);
            }
        }
    }
}

}  // namespace

Result<RecordedRun> read_run(const std::string& path, std::size_t slices, std::int64_t slice_us,
                             std::size_t most_poses) {
    RecordedRun run;
    FirstPass first(run, most_poses);
    auto faults = for_each_message(path, [&](const auto& message) { first.take(message); });
    if (!faults) return tl::unexpected(faults.error());
    run.faults = std::move(*faults);
    run.calls_missing = first.calls_missing();
    if (const auto left_out = first.poses_left_out(); left_out > 0) {
        run.faults.push_back(path + ": " + std::to_string(left_out) + " poses left out, after " +
                             std::to_string(most_poses));
    }
    place_slices(run, slices, slice_us);
    const auto again = for_each_message(path, [&](const mcap::MessageView& message) {
        if (message.channel->topic != topic::events) return;
        if (auto packet = decode_cdr<v1::EventPacket>(message.data)) fill_slices(run, *packet);
    });
    if (!again) return tl::unexpected(again.error());
    return run;
}

}  // namespace pursuit::ctl
