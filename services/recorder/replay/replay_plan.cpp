// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_plan.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "services/common/topics.hpp"
#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/packet_fields.hpp"
#include "services/recorder/replay/decoded.hpp"
#include "services/recorder/replay/recorded_calls.hpp"
#include "services/recorder/replay/replay_topics.hpp"
#include "services/recorder/replay/sensor_streams.hpp"
#include "services/recorder/replay/state_before.hpp"
#include "services/recorder/stream_gaps.hpp"

namespace pursuit::recorder {
namespace {

/// Goes through a recording in its order and gathers what make_plan() gives. Threads: one.
class Pass {
 public:
    void take(const mcap::MessageView& message);
    ReplayPlan finish();

 private:
    /// Which tracker a call is for; its sensor may become known later only.
    struct Callee {
        std::optional<std::uint32_t> sensor_id;
        std::string instance;
    };
    struct Gathered {
        PlannedCall call;
        Callee callee;
    };

    void take_packet(const std::string& topic, const std::optional<PacketFields>& packet);
    void take_request(mcap::ByteSpan data);
    void take_reply(mcap::ByteSpan data);
    void take_call(RecordedCall call);
    void take_model(mcap::ByteSpan data);
    void take_settings(mcap::ByteSpan data);
    void take_partitions(const mcap::Channel& channel);
    void add(v1::TrackerRequest request, Callee callee, std::size_t stream, std::size_t order);
    void plan_calls();
    std::optional<std::uint32_t> sensor_of(const std::string& instance) const;
    std::uint32_t likely_sensor_of(const std::string& instance) const;

    template <class T>
    std::optional<T> decode(mcap::ByteSpan data) {
        auto sample = decoded<T>(data);
        if (!sample) ++plan_.malformed;
        return sample;
    }

    ReplayPlan plan_;
    ClockSteps clock_steps_;
    StreamGaps gaps_;
    SensorStreams streams_;
    RecordedCalls recorded_;
    StateBefore before_;
    std::map<std::string, std::uint32_t> sensor_of_;  ///< By the tracker's instance.
    std::vector<Gathered> gathered_;
    bool too_many_ = false;
    std::set<const mcap::Channel*> seen_channels_;
};

void Pass::take(const mcap::MessageView& message) {
    const auto& channel = *message.channel;
    const auto& name = channel.topic;
    const bool is_sample = channel.message_encoding == mcap::message_encoding;
    std::optional<PacketFields> packet;
    if (is_sample && carries_packets(name)) packet = PacketFields::of(message.data);
    clock_steps_.take(message.head.log_time_ns, packet);
    if (!is_sample) return;
    ++plan_.messages[name];
    if (carries_packets(name)) {
        if (seen_channels_.insert(&channel).second) take_partitions(channel);
        take_packet(name, packet);
    } else if (name == topic::tracker_request) {
        take_request(message.data);
    } else if (name == topic::tracker_reply) {
        take_reply(message.data);
    } else if (name == topic::models) {
        take_model(message.data);
    } else if (name == topic::tracker_settings) {
        take_settings(message.data);
    }
}

void Pass::take_partitions(const mcap::Channel& channel) {
    const auto facts = mcap::replay_facts(channel);
    if (!facts || !*facts) return;  // unreadable facts do not keep the events from being replayed
    for (const auto& name : (*facts)->partitions) {
        auto& known = plan_.partitions;
        if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end()) {
            known.push_back(name);
        }
    }
}

void Pass::take_packet(const std::string& name, const std::optional<PacketFields>& packet) {
    if (!packet) {
        ++plan_.malformed;
        return;
    }
    gaps_.take(name == topic::events ? 0 : 1, packet->stream_id(), packet->sequence_number());
    if (name == topic::events) streams_.take(packet->sensor_id(), packet->stream_id());
}

void Pass::take_request(mcap::ByteSpan data) {
    auto request = decode<v1::TrackerRequest>(data);
    if (!request) return;
    if (auto call = recorded_.take(std::move(*request))) take_call(std::move(*call));
}

void Pass::take_reply(mcap::ByteSpan data) {
    auto reply = decode<v1::TrackerReply>(data);
    if (!reply) return;
    const auto sensor_id = sensor_of(reply->header().instance_name().to_string());
    if (auto call = recorded_.take(std::move(*reply), streams_.current(sensor_id))) {
        take_call(std::move(*call));
    }
}

void Pass::take_call(RecordedCall call) {
    auto& [request, reply, stream, order] = call;
    if (reply.outcome().code() != v1::STATUS_OK) return;
    before_.take(call);
    if (request.call()._d() == v1::TRACKER_REGISTER_MODEL &&
        reply.result()._d() == v1::TRACKER_REGISTER_MODEL) {
        if (reply.result().register_model().already_registered()) return;  // it changed nothing
        const auto object_id = reply.result().register_model().object_id();
        request.call().register_model().object_id(object_id);
    }
    request.apply_at_us(reply.effective_time_us());
    const auto instance = reply.header().instance_name().to_string();
    add(std::move(request), {sensor_of(instance), instance}, stream, order);
}

void Pass::take_model(mcap::ByteSpan data) {
    const auto model = decode<v1::RegisteredModel>(data);
    if (model) before_.take(*model, streams_.current(model->sensor_id()));
}

void Pass::take_settings(mcap::ByteSpan data) {
    const auto settings = decode<v1::TrackerSettings>(data);
    if (!settings || sensor_of_.size() >= most_planned_calls) return;
    sensor_of_[settings->instance().to_string()] = settings->sensor_id();
    before_.take(*settings, streams_.current(settings->sensor_id()));
}

std::optional<std::uint32_t> Pass::sensor_of(const std::string& instance) const {
    const auto found = sensor_of_.find(instance);
    return found == sensor_of_.end() ? std::nullopt : std::optional(found->second);
}

/// Where no tracker said so: the sensor heard first.
std::uint32_t Pass::likely_sensor_of(const std::string& instance) const {
    return sensor_of(instance).value_or(streams_.first_sensor().value_or(0));
}

void Pass::add(v1::TrackerRequest request, Callee callee, std::size_t stream, std::size_t order) {
    if (gathered_.size() >= most_planned_calls) {
        too_many_ = true;
        return;
    }
    auto name = name_of(request);
    gathered_.push_back({{std::move(request), std::move(name), stream, order}, std::move(callee)});
}

/// Gives the gathered calls to their sensors, in order.
void Pass::plan_calls() {
    const bool several = sensor_of_.size() > 1;
    for (auto& [call, callee] : gathered_) {
        const auto sensor_id =
            callee.sensor_id ? *callee.sensor_id : likely_sensor_of(callee.instance);
        if (several) {  // each call to the tracker that it was for
            for (const auto& [instance, its_sensor_id] : sensor_of_) {
                if (its_sensor_id == sensor_id) call.request.header().instance_name(instance);
            }
        }
        plan_.calls[sensor_id].push_back(std::move(call));
    }
    for (auto& [sensor_id, calls] : plan_.calls) {
        std::stable_sort(calls.begin(), calls.end(), [](const auto& a, const auto& b) {
            return std::tuple(a.stream, a.request.apply_at_us(), a.order) <
                   std::tuple(b.stream, b.request.apply_at_us(), b.order);
        });
    }
}

ReplayPlan Pass::finish() {
    const auto sensor_of = [this](const std::string& name) { return likely_sensor_of(name); };
    for (auto& [request, sensor_id, instance, stream] : before_.calls(sensor_of)) {
        add(std::move(request), {sensor_id, std::move(instance)}, stream, 0);
    }
    plan_calls();
    plan_.clock_steps = clock_steps_.steps();
    plan_.gaps = gaps_.gaps();
    plan_.packets_missed = gaps_.missed();
    plan_.unanswered = recorded_.unanswered();
    plan_.unasked = recorded_.unasked();
    if (too_many_ || recorded_.too_many()) {
        plan_.damage = "more than " + std::to_string(most_planned_calls) +
                       " calls on the tracker; the later ones are left out";
    }
    return std::move(plan_);
}

}  // namespace

Result<ReplayPlan> make_plan(const std::string& path, const std::function<bool()>& stopped) {
    auto input = mcap::FileInput::open(path);
    if (!input) return tl::unexpected(input.error());
    auto reader = mcap::Reader::open(std::move(*input), path, {}, mcap::OnDamage::skip_chunk);
    if (!reader) return tl::unexpected(reader.error());
    Pass pass;
    std::string damage;
    while (!stopped()) {
        const auto message = reader->next();
        if (!message) {
            damage = message.error().message;
            break;
        }
        if (!*message) break;
        pass.take(**message);
    }
    auto plan = pass.finish();
    if (!damage.empty()) plan.damage = damage;
    return plan;
}

}  // namespace pursuit::recorder
