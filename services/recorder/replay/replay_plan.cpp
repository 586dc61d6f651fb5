// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_plan.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "services/common/request_id.hpp"
#include "services/common/topics.hpp"
#include "services/common/tracker_call_kinds.hpp"
#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/packet_fields.hpp"
#include "services/recorder/replay/decoded.hpp"
#include "services/recorder/stream_gaps.hpp"

namespace pursuit::recorder {
namespace {

/// So that no file exhausts the memory: a register call is up to 50 kB.
constexpr std::size_t most_calls = 10'000;

std::string describe(const v1::TrackerRequest& request) {
    const auto& call = request.call();
    const auto named = [&]() -> std::string {
        switch (call._d()) {
            case v1::TRACKER_REGISTER_MODEL:
                return "register model " + call.register_model().name().to_string();
            case v1::TRACKER_UPDATE_MODEL:
                return "update model " + call.update_model().name().to_string();
            case v1::TRACKER_REMOVE_MODEL:
                return "remove model " + call.remove_model().name().to_string();
            case v1::TRACKER_SET_POSE:
                return "set pose of " + call.set_pose().name().to_string();
            case v1::TRACKER_SET_OCCLUSION_STRATEGY:
                return "set occlusion strategy";
            case v1::TRACKER_SET_PARAMETERS:
                return "set parameters " + call.set_parameters().name().to_string();
            default:
                return "call";
        }
    };
    return named() + " at " + std::to_string(request.apply_at_us()) + " us";
}

v1::TrackerRequest register_request(const v1::RegisteredModel& model) {
    v1::RegisterModel call;
    call.object_id(model.object_id());
    call.name(model.name());
    call.transform(model.transform());
    call.estimator(model.estimator());
    call.start(model.start());
    call.parameters(model.parameters());
    call.points(model.points());
    call.edges(model.edges());
    v1::TrackerRequest request;
    request.apply_at_us(model.effective_time_us());
    request.call().register_model(call);
    return request;
}

/// Goes through a recording in its order and gathers what make_plan() gives.
class Pass {
 public:
    void take(const mcap::MessageView& message);
    ReplayPlan finish();

 private:
    /// Where a call belongs; its sensor may become known later only.
    struct Place {
        std::optional<std::uint32_t> sensor_id;
        std::string instance;
        std::size_t stream = 0;
    };
    struct Gathered {
        PlannedCall call;
        Place place;
    };
    /// Request and reply come on two topics: nothing keeps the recorder from hearing the reply
    /// first.
    struct Exchange {
        std::optional<v1::TrackerRequest> request;
        std::optional<v1::TrackerReply> reply;
        std::size_t stream = 0;  ///< Of the reply.
        std::size_t order = 0;   ///< Of the reply.
        bool gathered = false;   ///< What is sent again of either is not a second call.
    };

    void take_packet(const std::string& topic, mcap::ByteSpan data);
    void take_request(mcap::ByteSpan data);
    void take_reply(mcap::ByteSpan data);
    Exchange* exchange(const v1::RequestId& id);
    void gather(Exchange& exchange);
    void take_model(mcap::ByteSpan data);
    void take_settings(mcap::ByteSpan data);
    void take_partitions(const mcap::Channel& channel);
    void add(v1::TrackerRequest request, Place place, std::size_t order);
    std::size_t current_stream(std::optional<std::uint32_t> sensor_id) const;

    template <class T>
    std::optional<T> decode(mcap::ByteSpan data) {
        auto sample = decoded<T>(data);
        if (!sample) ++plan_.malformed;
        return sample;
    }

    ReplayPlan plan_;
    StreamGaps gaps_;
    std::map<std::uint32_t, std::vector<std::uint64_t>> streams_;  ///< By sensor, as they came.
    std::optional<std::uint32_t> first_sensor_;
    std::map<std::string, std::uint32_t> sensor_of_;  ///< By the tracker's instance.
    std::map<RequestKey, Exchange> exchanges_;
    std::vector<Gathered> gathered_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<v1::RegisteredModel, std::size_t>>
        first_models_;  ///< By sensor and object; with the stream.
    std::map<std::string, std::pair<v1::TrackerSettings, std::size_t>> first_settings_;
    std::set<std::uint32_t> registered_;      ///< Object ids that a recorded call registered.
    std::set<std::int64_t> settings_called_;  ///< Effective times of recorded calls on settings.
    std::size_t order_ = 0;
    bool too_many_ = false;
    std::set<const mcap::Channel*> seen_channels_;
};

void Pass::take(const mcap::MessageView& message) {
    const auto& channel = *message.channel;
    if (channel.message_encoding != mcap::message_encoding) return;
    const auto& name = channel.topic;
    ++plan_.messages[name];
    if (name == topic::events || name == topic::exposures) {
        if (seen_channels_.insert(&channel).second) take_partitions(channel);
        take_packet(name, message.data);
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

void Pass::take_packet(const std::string& name, mcap::ByteSpan data) {
    const auto packet = PacketFields::of(data);
    if (!packet) {
        ++plan_.malformed;
        return;
    }
    gaps_.take(name == topic::events ? 0 : 1, packet->stream_id(), packet->sequence_number());
    if (name != topic::events) return;
    if (!first_sensor_) first_sensor_ = packet->sensor_id();
    auto& streams = streams_[packet->sensor_id()];
    if (std::find(streams.begin(), streams.end(), packet->stream_id()) == streams.end()) {
        streams.push_back(packet->stream_id());
    }
}

std::size_t Pass::current_stream(std::optional<std::uint32_t> sensor_id) const {
    if (!sensor_id) sensor_id = first_sensor_;
    const auto streams = sensor_id ? streams_.find(*sensor_id) : streams_.end();
    return streams == streams_.end() || streams->second.empty() ? 0 : streams->second.size() - 1;
}

Pass::Exchange* Pass::exchange(const v1::RequestId& id) {
    const auto key = key_of(id);
    const auto known = exchanges_.find(key);
    if (known != exchanges_.end()) return &known->second;
    if (exchanges_.size() >= most_calls) {
        too_many_ = true;
        return nullptr;
    }
    return &exchanges_[key];
}

void Pass::take_request(mcap::ByteSpan data) {
    auto request = decode<v1::TrackerRequest>(data);
    if (!request || !changes_tracker(request->call()._d())) return;
    auto* found = exchange(request->header().request_id());
    if (found == nullptr || found->request || found->gathered) return;
    found->request = std::move(*request);
    if (found->reply) gather(*found);
}

void Pass::take_reply(mcap::ByteSpan data) {
    auto reply = decode<v1::TrackerReply>(data);
    if (!reply || !changes_tracker(reply->result()._d())) return;
    auto* found = exchange(reply->header().related_request_id());
    if (found == nullptr || found->reply || found->gathered) return;
    const auto sensor = sensor_of_.find(reply->header().instance_name().to_string());
    found->stream =
        current_stream(sensor == sensor_of_.end() ? std::nullopt : std::optional(sensor->second));
    found->order = ++order_;
    found->reply = std::move(*reply);
    if (found->request) gather(*found);
}

void Pass::gather(Exchange& exchange) {
    auto request = std::move(*exchange.request);
    const auto reply = std::move(*exchange.reply);
    exchange.request.reset();
    exchange.reply.reset();
    exchange.gathered = true;
    if (reply.outcome().code() != v1::STATUS_OK) return;
    const auto effective_us = reply.effective_time_us();
    const auto kind = request.call()._d();
    if (kind == v1::TRACKER_REGISTER_MODEL && reply.result()._d() == v1::TRACKER_REGISTER_MODEL) {
        const auto& result = reply.result().register_model();
        if (!result.already_registered()) registered_.insert(result.object_id());
        request.call().register_model().object_id(result.object_id());
    }
    const bool of_all = kind == v1::TRACKER_SET_PARAMETERS &&
                        request.call().set_parameters().name().to_string().empty();
    if (kind == v1::TRACKER_SET_OCCLUSION_STRATEGY || of_all) settings_called_.insert(effective_us);
    request.apply_at_us(effective_us);
    const auto instance = reply.header().instance_name().to_string();
    const auto sensor = sensor_of_.find(instance);
    const auto sensor_id =
        sensor == sensor_of_.end() ? std::nullopt : std::optional(sensor->second);
    add(std::move(request), {sensor_id, instance, exchange.stream}, exchange.order);
}

void Pass::take_model(mcap::ByteSpan data) {
    const auto model = decode<v1::RegisteredModel>(data);
    if (!model || !model->registered() || first_models_.size() >= most_calls) return;
    first_models_.try_emplace({model->sensor_id(), model->object_id()}, *model,
                              current_stream(model->sensor_id()));
}

void Pass::take_settings(mcap::ByteSpan data) {
    const auto settings = decode<v1::TrackerSettings>(data);
    if (!settings || first_settings_.size() >= most_calls) return;
    const auto instance = settings->instance().to_string();
    sensor_of_[instance] = settings->sensor_id();
    first_settings_.try_emplace(instance, *settings, current_stream(settings->sensor_id()));
}

void Pass::add(v1::TrackerRequest request, Place place, std::size_t order) {
    if (gathered_.size() >= most_calls) {
        too_many_ = true;
        return;
    }
    auto name = describe(request);
    gathered_.push_back({{std::move(request), std::move(name), place.stream, order}, place});
}

ReplayPlan Pass::finish() {
    // What held before the recording: settings first, because models take gains from them.
    for (const auto& [instance, first] : first_settings_) {
        const auto& [settings, stream] = first;
        if (settings_called_.contains(settings.effective_time_us())) continue;
        const Place place{settings.sensor_id(), instance, stream};
        v1::TrackerRequest strategy;
        strategy.apply_at_us(settings.effective_time_us());
        v1::SetOcclusionStrategy set;
        set.strategy(settings.strategy());
        set.parameters(settings.strategy_parameters());
        strategy.call().set_occlusion_strategy(set);
        add(std::move(strategy), place, 0);
        if (settings.parameters().empty()) continue;
        v1::TrackerRequest parameters;
        parameters.apply_at_us(settings.effective_time_us());
        v1::SetParameters all;
        all.parameters(settings.parameters());
        parameters.call().set_parameters(all);
        add(std::move(parameters), place, 0);
    }
    for (const auto& [key, first] : first_models_) {
        const auto& [model, stream] = first;
        if (registered_.contains(model.object_id())) continue;
        add(register_request(model), {model.sensor_id(), "", stream}, 0);
    }
    const bool several = sensor_of_.size() > 1;
    for (auto& [call, place] : gathered_) {
        if (!place.sensor_id) {
            const auto sensor = sensor_of_.find(place.instance);
            place.sensor_id =
                sensor == sensor_of_.end() ? first_sensor_.value_or(0) : sensor->second;
        }
        if (several) {  // each call to the tracker that it was for
            for (const auto& [instance, sensor_id] : sensor_of_) {
                if (sensor_id == *place.sensor_id) call.request.header().instance_name(instance);
            }
        }
        plan_.calls[*place.sensor_id].push_back(std::move(call));
    }
    for (auto& [sensor_id, calls] : plan_.calls) {
        std::stable_sort(calls.begin(), calls.end(), [](const auto& a, const auto& b) {
            return std::tuple(a.stream, a.request.apply_at_us(), a.order) <
                   std::tuple(b.stream, b.request.apply_at_us(), b.order);
        });
    }
    plan_.gaps = gaps_.gaps();
    plan_.packets_missed = gaps_.missed();
    for (const auto& [key, exchange] : exchanges_) {
        if (exchange.request && !exchange.reply) ++plan_.unanswered;
    }
    if (too_many_) {
        plan_.damage = "more than " + std::to_string(most_calls) +
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
