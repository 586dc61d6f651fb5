// SPDX-License-Identifier: Apache-2.0
// AEDAT 2.0 and 4, and the 40-bit events of N-MNIST.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <random>

#include "services/sensor/formats/formats.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::sensor {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Events = std::vector<Event>;

std::string nmnist(unsigned x, unsigned y, unsigned polarity, unsigned t_us) {
    const unsigned word[] = {x, y, polarity << 7 | t_us >> 16, t_us >> 8 & 0xff, t_us & 0xff};
    std::string bytes;
    for (const auto byte : word) bytes += static_cast<char>(byte);
    return bytes;
}

ReadAll decode_bin(const std::string& bytes, const ReadOptions& options = {}) {
    return decode_bytes("a.bin", bytes, options);
}

TEST(NmnistReader, reads_forty_bits_an_event_and_the_markers_of_time) {
    const auto all = decode_bin(nmnist(33, 0, 1, 0x7ffff0) + nmnist(0, 33, 0, 3) +
                                nmnist(5, 240, 1, 4) + nmnist(1, 2, 1, 5));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(
        all.events,
        (Events{{0x7ffff0, 33, 0, 1}, {(1 << 23) + 3, 0, 33, 0}, {(1 << 23) + 5 + 8192, 1, 2, 1}}));
}

TEST(NmnistReader, an_event_that_is_late_across_the_wrap_goes_back_and_time_does_not_jump) {
    const auto all = decode_bin(nmnist(1, 1, 1, 0x7ffff0) + nmnist(1, 1, 1, 3) +
                                nmnist(1, 1, 1, 0x7ffff8) + nmnist(1, 1, 1, 5));
    EXPECT_EQ(all.events.size(), 2U);
    EXPECT_EQ(all.error, "a.bin: byte 10: time goes back from 8388611 to 8388600 us");
}

TEST(NmnistReader, takes_the_small_array_only_where_the_events_fit) {
    ReadOptions asked;
    asked.geometry = Geometry{50, 50};
    for (const auto& [bytes, options, geometry] :
         std::vector<std::tuple<std::string, ReadOptions, Geometry>>{
             {nmnist(33, 33, 0, 1), {}, {34, 34}},
             {nmnist(34, 33, 0, 1), {}, {304, 240}},
             {nmnist(1, 240, 0, 1), {}, {34, 34}},
             {nmnist(1, 1, 0, 1), asked, {50, 50}}}) {
        auto reader = open_events(
            from_memory("a.bin",
                        {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}),
            options);
        EXPECT_EQ((*reader)->geometry(), geometry);
    }
}

TEST(NmnistReader, delivers_the_good_events_before_each_kind_of_bad_one) {
    ReadOptions options;
    options.geometry = Geometry{34, 34};
    for (const auto& [bad, cause] : std::vector<std::pair<std::string, std::string>>{
             {nmnist(34, 0, 1, 9), "pixel (34, 0) is outside 34x34"},
             {nmnist(0, 0, 1, 7), "time goes back from 8 to 7 us"},
             {"abc", "the file ends within an event, after 3 of 5 bytes"}}) {
        const auto all = decode_bin(nmnist(1, 1, 1, 8) + bad, options);
        EXPECT_EQ(all.events, (Events{{8, 1, 1, 1}}));
        EXPECT_EQ(all.error, "a.bin: byte 5: " + cause);
    }
}

std::string big_endian(std::uint32_t word) {
    const auto bytes = little_endian(word);
    return {bytes.rbegin(), bytes.rend()};
}

std::string aedat2(std::uint32_t address, std::uint32_t t_us) {
    return big_endian(address) + big_endian(t_us);
}

const std::string aedat2_header = "#!AER-DAT2.0\r\n# a remark\r\n";

TEST(Aedat2Reader, reads_a_dvs128_and_unwraps_its_unsigned_time) {
    const auto all =
        decode_bytes("a.aedat", aedat2_header + aedat2(3 << 8 | 0 << 1, 0xffff'fff0) +
                                    aedat2(0x8000, 5) + aedat2(127 << 8 | 127 << 1 | 1, 6));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events,
              (Events{{0xffff'fff0, 127, 3, 1}, {(std::int64_t{1} << 32) + 6, 0, 127, 0}}));
}

TEST(Aedat2Reader, an_event_that_is_late_across_the_wrap_goes_back_and_time_does_not_jump) {
    const auto all = decode_bytes("a.aedat", aedat2_header + aedat2(0, 0xffff'fff0) + aedat2(0, 5) +
                                                 aedat2(0, 0xffff'fff8) + aedat2(0, 7));
    EXPECT_EQ(all.events.size(), 2U);
    EXPECT_EQ(all.error, "a.aedat: byte 42: time goes back from 4294967301 to 4294967288 us");
}

TEST(Aedat2Reader, reads_a_davis_past_its_frames_and_samples) {
    const auto header = aedat2_header + "# AEChip: eu.seebetter.ini.chips.davis.DAVIS240C\r\n";
    const auto all = decode_bytes("a.aedat", header + aedat2(7U << 22 | 9U << 12 | 1U << 11, 5) +
                                                 aedat2(1U << 31, 6) + aedat2(1U << 10, 7) +
                                                 aedat2(179U << 22 | 239U << 12, 8));
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, (Events{{5, 230, 7, 1}, {8, 0, 179, 0}}));
}

TEST(Aedat2Reader, names_the_byte_and_cause_of_what_is_wrong) {
    const auto error = [](const std::string& bytes) {
        return decode_bytes("a.aedat", bytes).error;
    };
    EXPECT_EQ(error("#!AER-DAT3.1\r\n"),
              "a.aedat: byte 0: \"#!AER-DAT3.1\" is not read, only 2.0 (and 4)");
    EXPECT_EQ(error("x"), "a.aedat: byte 0: does not begin with \"#!AER-DAT2.0\"");
    EXPECT_EQ(error("#!AER-DAT2.0\r\n# AEChip: ABC\r\n"),
              "a.aedat: byte 14: events of the camera \"ABC\" are not read, only of DVS128, "
              "DAVIS240 and DAVIS346");
    const auto good = aedat2_header + aedat2(0, 9);
    const auto at = "a.aedat: byte " + std::to_string(good.size()) + ": ";
    EXPECT_EQ(error(good + aedat2(0, 8)), at + "time goes back from 9 to 8 us");
    EXPECT_EQ(error(good + aedat2(1 << 16, 10)), at + "address 65536 is none of a DVS128");
    EXPECT_EQ(error(good + "abcd"), at + "the file ends within an event, after 4 of 8 bytes");
    EXPECT_EQ(error(aedat2_header + "# AEChip: DAVIS346\n" + aedat2(260U << 22, 9)),
              "a.aedat: byte " + std::to_string(aedat2_header.size() + 19) +
                  ": pixel (0, 260) is outside 346x260 (x mirrored)");
}

TEST(Aedat2Reader, a_header_line_that_is_too_long_or_no_text_is_not_taken_for_events) {
    const std::string line = "# created Wed Oct 12 10:00:00 CEST 2016";
    const auto error = [&](const std::string& more) {
        return decode_bytes("a.aedat", aedat2_header + line + more + "\r\n" + aedat2(0, 9)).error;
    };
    EXPECT_EQ(error(std::string(4094 - line.size(), 'x')), "");
    const auto at = "a.aedat: byte " + std::to_string(aedat2_header.size()) + ": ";
    EXPECT_EQ(error(std::string(4097 - line.size(), 'x')),
              at + "a header line longer than 4096 bytes");
    EXPECT_EQ(error("\x01"), at + "a control character in a header line");
}

// Tables of FlatBuffers, laid out by hand.
std::string table(const std::string& identifier, unsigned root, const std::string& rest) {
    const auto body = little_endian(std::uint32_t{root}) + identifier + rest;
    return little_endian(static_cast<std::uint32_t>(body.size())) + body;
}

std::string u16(unsigned value) { return little_endian(static_cast<std::uint16_t>(value)); }
std::string u32(std::size_t value) { return little_endian(static_cast<std::uint32_t>(value)); }

std::string packet_of(const Events& events) {
    auto rest = std::string(2, '\0') + u16(6) + u16(8) + u16(4);  // the fields of the table at 16
    rest += u32(6) + u32(4) + u32(events.size());
    for (const auto& event : events) {
        rest += little_endian(event.t_us) + u16(event.x) + u16(event.y) +
                static_cast<char>(event.polarity) + std::string(3, '\0');
    }
    return table("EVTS", 16, rest);
}

enum Compression : std::uint32_t { none, lz4, lz4_high, zstd };

std::string file_header(std::uint32_t compression, const std::string& xml,
                        std::int64_t packets_end = -1) {
    auto rest = u16(10) + u16(20) + u16(4) + u16(8) + u16(16) + u16(0);  // of the table at 20
    rest += u32(12) + u32(compression) + little_endian(packets_end) + u32(4);
    rest += u32(xml.size()) + xml + std::string(8 - xml.size() % 4, '\0');
    return "#!AER-DAT4.0\r\n" + table("IOHE", 20, rest);
}

std::string stream_of(int id, const std::string& type, int width = 346, int height = 260) {
    return "<node name=\"" + std::to_string(id) + "\"><attr key=\"typeIdentifier\">" + type +
           "</attr><node name=\"info\"><attr key=\"sizeX\">" + std::to_string(width) +
           "</attr><attr key=\"sizeY\">" + std::to_string(height) + "</attr></node></node>";
}

std::string xml_of(const std::string& streams) {
    return "<dv version=\"2.0\"><node name=\"outInfo\">" + streams + "</node></dv>";
}

std::string framed(std::size_t stream, const std::string& bytes) {
    return u32(stream) + u32(bytes.size()) + bytes;
}

std::string packed(std::uint32_t compression, const std::string& bytes) {
    if (compression == none) return bytes;
    std::string out(
        LZ4F_compressFrameBound(bytes.size(), nullptr) + ZSTD_compressBound(bytes.size()), '\0');
    out.resize(
        compression == zstd
            ? ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1)
            : LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    return out;
}

const Events some = {{1'600'000'000'000'000, 1, 2, 1}, {1'600'000'000'000'005, 345, 259, 0}};
const Events more = {{1'600'000'000'000'006, 3, 4, 1}};

ReadAll decode4(const std::string& bytes, const ReadOptions& options = {}) {
    return decode_bytes("a.aedat4", bytes, options, 1);
}

TEST(Aedat4Reader, reads_the_packets_of_its_stream_however_they_are_packed) {
    const auto xml = xml_of(stream_of(1, "FRME") + stream_of(2, "EVTS") + stream_of(0, "IMUS"));
    for (const auto compression : {none, lz4, lz4_high, zstd}) {
        const auto bytes = file_header(compression, xml) + framed(1, "neither packed nor a table") +
                           framed(2, packed(compression, packet_of(some))) +
                           framed(2, packed(compression, packet_of({}))) +
                           framed(2, packed(compression, packet_of(more)));
        for (const auto& all : {decode4(bytes), decode_chunks("a.aedat4", bytes, 7)}) {
            EXPECT_EQ(all.error, "");
            EXPECT_EQ(all.events, (Events{some[0], some[1], more[0]}));
        }
    }
}

TEST(Aedat4Reader, takes_the_first_camera_and_counts_the_events_of_others) {
    const auto bytes =
        file_header(none, xml_of(stream_of(4, "EVTS", 9, 9) + stream_of(3, "EVTS", 640, 480))) +
        framed(4, packet_of(some)) + framed(3, packet_of(more)) + framed(4, packet_of(more));
    const auto all = decode4(bytes);
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.events, more);
    EXPECT_EQ(all.skipped, 3U);
}

TEST(Aedat4Reader, stops_where_the_packets_end_and_misses_what_is_cut_off) {
    const auto xml = xml_of(stream_of(0, "EVTS"));
    const auto packet = framed(0, packet_of(some));
    const auto size = file_header(none, xml).size() + packet.size();
    const auto header = file_header(none, xml, static_cast<std::int64_t>(size));
    EXPECT_EQ(decode4(header + packet + "the table of data").error, "");
    const auto longer = file_header(none, xml, static_cast<std::int64_t>(size + 1)) + packet;
    const auto all = decode4(longer);
    EXPECT_EQ(all.events, some);
    EXPECT_EQ(all.error, "a.aedat4: byte " + std::to_string(size) +
                             ": the file ends here, its packets are to end at byte " +
                             std::to_string(size + 1));
}

TEST(Aedat4Reader, names_the_byte_and_cause_of_what_is_wrong_in_a_header) {
    const auto xml = xml_of(stream_of(0, "EVTS"));
    EXPECT_EQ(decode4("#!AER-DAT4.1\r\n").error,
              "a.aedat4: byte 0: does not begin with \"#!AER-DAT4.0\"");
    EXPECT_EQ(decode4("#!AER-DAT4.0\r\nab").error, "a.aedat4: byte 16: the file ends here");
    EXPECT_EQ(decode4("#!AER-DAT4.0\r\n" + u32(1 << 18)).error,
              "a.aedat4: byte 14: a header of 262144 bytes, at most 131072 are read");
    EXPECT_THAT(decode4("#!AER-DAT4.0\r\n" + u32(100)).error,
                HasSubstr("byte 14: the file ends within its header, after 4 of 104 bytes"));
    EXPECT_EQ(decode4("#!AER-DAT4.0\r\n" + u32(16) + std::string(16, 'x')).error,
              "a.aedat4: byte 14: the header is damaged");
    EXPECT_EQ(decode4(file_header(9, xml)).error,
              "a.aedat4: byte 14: compression of kind 9 is unknown");
    EXPECT_EQ(decode4(file_header(none, "<dv")).error,
              "a.aedat4: byte 14: the description of the streams is no XML");
    EXPECT_EQ(decode4(file_header(none, xml_of(stream_of(0, "IMUS")))).error,
              "a.aedat4: byte 14: no stream of events is described");
    EXPECT_EQ(decode4(file_header(none, xml_of(stream_of(0, "EVTS", 0, 0)))).error,
              "a.aedat4: byte 14: the header states no size of the stream of events");
}

TEST(Aedat4Reader, delivers_the_good_events_before_each_kind_of_bad_packet) {
    const auto good = file_header(none, xml_of(stream_of(0, "EVTS") + stream_of(5, "IMUS"))) +
                      framed(0, packet_of(some));
    const auto at = "a.aedat4: byte " + std::to_string(good.size()) + ": ";
    const auto late = some[1].t_us;
    for (const auto& [bad, cause] : std::vector<std::pair<std::string, std::string>>{
             {framed(0, packet_of({{late - 1, 1, 1, 0}})),
              "event 0 of the packet: time goes back from 1600000000000005 to 1600000000000004 us"},
             {framed(0, packet_of({{std::int64_t{1} << 53, 1, 1, 0}})),
              "event 0 of the packet: time 9007199254740992 us is not below 2^53 us"},
             {framed(0, packet_of({{late, 346, 1, 0}})),
              "event 0 of the packet: pixel (346, 1) is outside 346x260"},
             {framed(0, packet_of({{late, 1, 1, 2}})),
              "event 0 of the packet: polarity 2 is not 0 or 1"},
             {framed(0, "no table"), "the packet is damaged: no table of events"},
             {framed(0, ""), "the packet is damaged: no table of events"},
             {u32(0) + u32(100) + "abc", "the file ends within a packet, after 3 of 100 bytes"},
             {u32(5) + u32(100) + "abc", "the file ends within a packet, after 3 of 100 bytes"},
             {u32(0) + u32(1U << 31), "a packet of 2147483648 bytes, at most 67108864 are read"},
             {"abc", "the file ends within the header of a packet, after 3 of 8 bytes"}}) {
        const auto all = decode4(good + bad);
        EXPECT_EQ(all.events, some);
        EXPECT_EQ(all.error, at + cause);
    }
}

TEST(Aedat4Reader, a_packet_of_a_stream_that_the_header_does_not_describe_is_an_error) {
    const auto good = file_header(none, xml_of(stream_of(0, "EVTS") + stream_of(1, "FRME"))) +
                      framed(0, packet_of(some)) + framed(1, "a frame");
    const auto all = decode4(good + framed(64, packet_of(more)) + framed(0, packet_of(more)));
    EXPECT_EQ(all.events, some);
    EXPECT_EQ(all.error, "a.aedat4: byte " + std::to_string(good.size()) +
                             ": a packet of stream 64, which the header does not describe");
}

TEST(Aedat4Reader, refuses_damaged_incomplete_and_monstrous_compression) {
    for (const auto compression : {lz4, zstd}) {
        const auto header = file_header(compression, xml_of(stream_of(0, "EVTS")));
        const auto whole = packed(compression, packet_of(some));
        const auto at = "a.aedat4: byte " + std::to_string(header.size()) + ": the packet is ";
        EXPECT_THAT(decode4(header + framed(0, "12345678")).error, StartsWith(at + "damaged"));
        EXPECT_EQ(decode4(header + framed(0, whole.substr(0, whole.size() - 6))).error,
                  at + "incomplete");
        const std::string zeros(70 << 20, '\0');
        EXPECT_EQ(decode4(header + framed(0, packed(compression, zeros))).error,
                  at + "more than 67108864 bytes unpacked");
    }
}

TEST(Recordings, of_every_kind_give_the_same_however_their_bytes_arrive) {
    std::mt19937 random(5);
    for (const std::string name :
         {"decoders/ncars_004397.es", "decoders/ncars_004397_td.dat", "decoders/evt3_triggers.raw",
          "decoders/nmnist_digit.bin", "decoders/two_cars.aedat4", "decoders/foam90.aedat"}) {
        PURSUIT_DATA_OR_SKIP(path, name);
        const auto bytes = test::content_of(path);
        const auto expected = decode_bytes(name, bytes);
        EXPECT_EQ(expected.error, "");
        for (int round = 0; round < 3; ++round) {
            const auto all =
                decode_chunks(name, bytes, 1 + random() % 5000, {}, 1 + random() % 3000);
            EXPECT_EQ(all.error, "");
            EXPECT_EQ(all.events, expected.events);
        }
    }
}

}  // namespace
}  // namespace pursuit::sensor
