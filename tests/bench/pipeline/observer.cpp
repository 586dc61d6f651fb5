// SPDX-License-Identifier: Apache-2.0
// The process at the end of the pipeline benchmark: receives poses, event packets or both, notes
// when, and writes what it noted as CSV when it is told to end (SIGTERM).
//
//   observer DOMAIN (poses|packets) FILE
//
// Prints "matched N" whenever the number of writers that it hears has changed.
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "services/common/clock.hpp"
#include "services/common/reader.hpp"
#include "services/sensor/packed_event.hpp"

namespace pursuit {
namespace {

volatile sig_atomic_t ended = 0;

/// Rows are noted up to this many, in memory that is there from the start.
constexpr std::size_t most_rows = 2'000'000;

struct PoseRow {
    std::int64_t received_ns, written_ns, host_time_ns, t_us, last_event_t_us;
    std::uint64_t sequence_number, events_used;
    std::uint32_t object_id;
    int state;
    double x_px, y_px;
};

struct PacketRow {
    std::int64_t received_ns, written_ns, host_time_ns, base_time_us, last_t_us;
    std::uint64_t sequence_number;
    std::size_t events;
};

PoseRow row_of(const v1::ObjectPose& pose, std::int64_t received_ns, std::int64_t written_ns) {
    return {received_ns,
            written_ns,
            pose.host_time_ns(),
            pose.t_us(),
            pose.last_event_t_us(),
            pose.sequence_number(),
            pose.events_used(),
            pose.object_id(),
            static_cast<int>(pose.state()),
            pose.x_px(),
            pose.y_px()};
}

PacketRow row_of(const v1::EventPacket& packet, std::int64_t received_ns, std::int64_t written_ns) {
    const auto& words = packet.words();
    return {received_ns,
            written_ns,
            packet.host_time_ns(),
            packet.base_time_us(),
            words.empty() ? packet.base_time_us()
                          : sensor::unpack(words.back(), packet.base_time_us()).t_us,
            packet.sequence_number(),
            words.size()};
}

constexpr auto header(const PoseRow*) {
    return "received_ns,written_ns,host_time_ns,t_us,last_event_t_us,sequence_number,events_used,"
           "object_id,state,x_px,y_px\n";
}
constexpr auto header(const PacketRow*) {
    return "received_ns,written_ns,host_time_ns,base_time_us,last_t_us,sequence_number,events\n";
}

using Number = long long;

void print(std::FILE* file, const PoseRow& r) {
    std::fprintf(file, "%lld,%lld,%lld,%lld,%lld,%lld,%lld,%u,%d,%.6f,%.6f\n",
                 Number{r.received_ns}, Number{r.written_ns}, Number{r.host_time_ns},
                 Number{r.t_us}, Number{r.last_event_t_us}, static_cast<Number>(r.sequence_number),
                 static_cast<Number>(r.events_used), r.object_id, r.state, r.x_px, r.y_px);
}
void print(std::FILE* file, const PacketRow& r) {
    std::fprintf(file, "%lld,%lld,%lld,%lld,%lld,%lld,%zu\n", Number{r.received_ns},
                 Number{r.written_ns}, Number{r.host_time_ns}, Number{r.base_time_us},
                 Number{r.last_t_us}, static_cast<Number>(r.sequence_number), r.events);
}

template <class Sample, class Row>
int observe(Participant& participant, const char* topic, const std::string& path) {
    SystemClock clock;
    std::mutex mutex;
    std::vector<Row> rows;
    rows.reserve(most_rows);
    auto reader = Reader<Sample>::create(participant, topic, [&](Sample& sample, const auto& info) {
        const auto received_ns = clock.realtime_ns();
        const std::scoped_lock lock(mutex);
        if (rows.size() < most_rows) {
            rows.push_back(row_of(sample, received_ns, info.source_timestamp.to_ns()));
        }
    });
    if (!reader) {
        std::fprintf(stderr, "observer: %s\n", reader.error().message.c_str());
        return 1;
    }
    for (int told = 0; ended == 0; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
        const int matched = (*reader)->matched();
        if (matched == told) continue;
        told = matched;
        std::printf("matched %d\n", matched);
        std::fflush(stdout);
    }
    reader->reset();
    std::FILE* file = std::fopen(path.c_str(), "we");
    if (file == nullptr) {
        std::fprintf(stderr, "observer: cannot create %s\n", path.c_str());
        return 1;
    }
    std::fputs(header(rows.data()), file);
    for (const Row& row : rows) print(file, row);
    const bool good = std::ferror(file) == 0;
    return std::fclose(file) == 0 && good && rows.size() < most_rows ? 0 : 1;
}

}  // namespace
}  // namespace pursuit

int main(int argc, char** argv) {
    using namespace pursuit;
    const std::string what = argc == 4 ? argv[2] : "";
    if (what != "poses" && what != "packets") {
        std::fprintf(stderr, "observer DOMAIN (poses|packets) FILE\n");
        return 2;
    }
    ::signal(SIGTERM, [](int) { ended = 1; });
    disk::Dds settings;
    settings.set_domain(static_cast<std::uint32_t>(std::atoi(argv[1])));
    settings.set_loopback_only(true);
    auto participant = Participant::create(settings, "observer", "");
    if (!participant) {
        std::fprintf(stderr, "observer: %s\n", participant.error().message.c_str());
        return 1;
    }
    return what == "poses"
               ? observe<v1::ObjectPose, PoseRow>(**participant, topic::poses, argv[3])
               : observe<v1::EventPacket, PacketRow>(**participant, topic::events, argv[3]);
}
