// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/model_store.hpp"

#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>

#include "services/common/atomic_file.hpp"
#include "store.pb.h"

namespace pursuit::tracker {
namespace {

constexpr std::uint32_t store_format = 1;
constexpr std::uintmax_t max_store_bytes = 256ULL << 20;
constexpr std::uint32_t max_stored_objects = 256;

// Field 9 of type fixed32, as Protobuf writes it: the tag, then four bytes, low first.
constexpr char crc_tag = (9 << 3) | 5;
constexpr std::size_t crc_bytes = 5;

std::uint32_t crc_of(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string crc_field(std::uint32_t crc) {
    std::string field(1, crc_tag);
    for (int shift = 0; shift < 32; shift += 8) field += static_cast<char>(crc >> shift & 0xff);
    return field;
}

void put(disk::StoredPose& stored, const Pose& pose, const Velocity& velocity) {
    stored.set_x_px(pose.t_px.x());
    stored.set_y_px(pose.t_px.y());
    stored.set_a00(pose.a(0, 0));
    stored.set_a01(pose.a(0, 1));
    stored.set_a10(pose.a(1, 0));
    stored.set_a11(pose.a(1, 1));
    stored.set_vx_px_s(velocity.vx_px_s);
    stored.set_vy_px_s(velocity.vy_px_s);
    stored.set_omega_rad_s(velocity.omega_rad_s);
}

Start start_of(const disk::StoredPose& stored) {
    Start start;
    start.pose.t_px = {stored.x_px(), stored.y_px()};
    start.pose.a << stored.a00(), stored.a01(), stored.a10(), stored.a11();
    start.velocity.vx_px_s = stored.vx_px_s();
    start.velocity.vy_px_s = stored.vy_px_s();
    start.velocity.omega_rad_s = stored.omega_rad_s();
    return start;
}

template <class Repeated>
void put_values(Repeated* stored, const std::vector<NamedValue>& values) {
    for (const auto& value : values) {
        auto* entry = stored->Add();
        entry->set_name(value.name);
        entry->set_value(value.value);
    }
}

template <class Repeated>
std::vector<NamedValue> stored_values(const Repeated& stored) {
    std::vector<NamedValue> values;
    for (const auto& value : stored) values.push_back({value.name(), value.value()});
    return values;
}

void put(disk::StoredObject& stored, const StoredObject& entry) {
    const RegisteredObject& object = entry.object;
    stored.set_object_id(object.object_id);
    auto& model = *stored.mutable_model();
    model.set_name(object.shape.name);
    for (const auto& point_px : object.shape.points_px) {
        auto* point = model.add_point();
        point->set_x_px(point_px.x());
        point->set_y_px(point_px.y());
    }
    for (const auto& edge : object.shape.edges) {
        auto* piece = model.add_edge();
        piece->set_from(edge.from);
        piece->set_to(edge.to);
    }
    stored.set_transform(std::string(to_string(object.transform)));
    stored.set_estimator(std::string(to_string(object.estimator)));
    stored.set_search(object.start.search);
    put_values(stored.mutable_parameter(), values(object.parameters));
    put(*stored.mutable_start(), object.start.pose, object.start.velocity);
    if (!entry.track) return;
    put(*stored.mutable_last(), entry.track->pose, entry.track->velocity);
    stored.mutable_last()->set_t_us(entry.track->t_us);
    stored.set_last_state(std::string(to_string(entry.track->state)));
}

Result<StoredObject> object_of(const disk::StoredObject& stored) {
    const std::string where = "object " + std::to_string(stored.object_id()) + ": ";
    StoredObject entry;
    RegisteredObject& object = entry.object;
    object.object_id = stored.object_id();
    object.shape.name = stored.model().name();
    for (const auto& point : stored.model().point()) {
        object.shape.points_px.emplace_back(point.x_px(), point.y_px());
    }
    for (const auto& edge : stored.model().edge()) {
        constexpr std::uint32_t most = std::numeric_limits<std::uint16_t>::max();
        if (edge.from() > most || edge.to() > most)
            return fail(where + "model.edge: no such point");
        object.shape.edges.push_back(
            {static_cast<std::uint16_t>(edge.from()), static_cast<std::uint16_t>(edge.to())});
    }
    if (auto good = check(object.shape); !good) return fail(where + good.error().message);
    const auto transform = parse_transform(stored.transform());
    if (!transform) return fail(where + "transform: unknown \"" + stored.transform() + "\"");
    object.transform = *transform;
    const auto estimator = parse_estimator(stored.estimator());
    if (!estimator) return fail(where + "estimator: unknown \"" + stored.estimator() + "\"");
    object.estimator = *estimator;
    for (const auto& value : stored_values(stored.parameter())) {
        const auto good = set(object.parameters, std::span(&value, 1));
        // A parameter that this version does not know any more is no damage.
        if (!good && good.error().status != CallStatus::not_found) {
            return fail(where + good.error().message);
        }
    }
    object.start = start_of(stored.start());
    object.start.search = stored.search();
    if (!stored.has_last()) return entry;
    const auto state = parse_track_state(stored.last_state());
    if (!state) return fail(where + "last_state: unknown \"" + stored.last_state() + "\"");
    const Start last = start_of(stored.last());
    entry.track = TrackSnapshot{.object_id = object.object_id,
                                .state = *state,
                                .was_tracked = true,
                                .t_us = stored.last().t_us(),
                                .pose = last.pose,
                                .velocity = last.velocity};
    return entry;
}

Result<StoredState> state_of(const disk::Store& store) {
    StoredState state;
    state.moment.stream_id = store.stream_id();
    state.moment.last_t_us = store.has_last_t_us() ? store.last_t_us() : -1;
    state.next_object_id = store.has_next_object_id() ? store.next_object_id() : 1;
    if (store.has_strategy()) {
        state.settings.strategy = parse_strategy(store.strategy());
        if (!state.settings.strategy) {
            return fail("strategy: unknown \"" + store.strategy() + "\"");
        }
    }
    state.settings.strategy_parameters = stored_values(store.strategy_parameter());
    state.settings.parameters = stored_values(store.parameter());
    if (store.object_size() > static_cast<int>(max_stored_objects)) {
        return fail("object: " + std::to_string(store.object_size()) + " entries, at most " +
                    std::to_string(max_stored_objects));
    }
    std::uint32_t id_before = 0;
    for (const auto& stored : store.object()) {
        if (stored.object_id() <= id_before || stored.object_id() >= state.next_object_id) {
            return fail("object_id: " + std::to_string(stored.object_id()) +
                        " is out of order or not below next_object_id");
        }
        id_before = stored.object_id();
        auto object = object_of(stored);
        if (!object) return tl::unexpected(object.error());
        state.objects.push_back(std::move(*object));
    }
    return state;
}

}  // namespace

std::string encode_store(const StoredState& state) {
    disk::Store store;
    store.set_format(store_format);
    store.set_stream_id(state.moment.stream_id);
    store.set_last_t_us(state.moment.last_t_us);
    store.set_next_object_id(state.next_object_id);
    if (state.settings.strategy) {
        store.set_strategy(std::string(to_string(*state.settings.strategy)));
    }
    put_values(store.mutable_strategy_parameter(), state.settings.strategy_parameters);
    put_values(store.mutable_parameter(), state.settings.parameters);
    for (const auto& object : state.objects) put(*store.add_object(), object);
    std::string bytes = store.SerializeAsString();
    return bytes + crc_field(crc_of(bytes));
}

Result<StoredState> decode_store(std::string_view bytes) {
    if (bytes.size() < crc_bytes) {
        return fail("the file ends at byte " + std::to_string(bytes.size()) +
                    ", before its checksum");
    }
    const auto content = bytes.substr(0, bytes.size() - crc_bytes);
    if (bytes.substr(content.size()) != crc_field(crc_of(content))) {
        return fail("the checksum of its " + std::to_string(bytes.size()) + " bytes is wrong");
    }
    disk::Store store;
    if (!store.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
        return fail("not a tracker store");
    }
    if (store.format() != store_format) {
        return fail("format: " + std::to_string(store.format()) + ", this version reads " +
                    std::to_string(store_format));
    }
    return state_of(store);
}

Result<FoundStore> read_store(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        if (error) return fail(path + ": cannot be looked for: " + error.message());
        return FoundStore();
    }
    if (!std::filesystem::is_regular_file(path, error)) {
        return fail(path + ": is no regular file, as a store must be");
    }
    const auto size = std::filesystem::file_size(path, error);
    if (error) return fail(path + ": cannot be read: " + error.message());
    Result<StoredState> state = fail("larger than 256 MiB");
    if (size <= max_store_bytes) {
        std::ifstream in(path, std::ios::binary);
        std::ostringstream bytes;
        if (in && size > 0) bytes << in.rdbuf();
        if (!in || !bytes) return fail(path + ": cannot be read: " + std::strerror(errno));
        state = decode_store(bytes.str());
    }
    if (state) return FoundStore{std::move(*state), ""};
    const std::string damage = path + ": the store is damaged: " + state.error().message;
    // A link stays, as it does where the store is written.
    const auto file = followed_links(path);
    if (!file) return tl::unexpected(file.error());
    const std::string aside = *file + ".damaged";
    std::filesystem::rename(*file, aside, error);
    if (error) return fail(damage + "; it cannot be kept aside: " + error.message());
    return FoundStore{std::nullopt, damage + "; it is kept as " + aside};
}

Result<void> write_store(const std::string& path, const StoredState& state) {
    return write_file_atomically(path, encode_store(state));
}

}  // namespace pursuit::tracker
