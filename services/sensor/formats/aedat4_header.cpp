// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/aedat4_header.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <string>

#include "aedat4_generated.h"
#include "services/sensor/formats/records.hpp"
#include "services/sensor/formats/text_line.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t most_header_bytes = 1 << 17;  // fits the window
constexpr std::size_t most_streams = 64;

/// The text of <attr key="KEY">TEXT</attr> in a node; empty where there is none.
std::string_view attribute(const tinyxml2::XMLElement& node, const char* key) {
    for (const auto* attr = node.FirstChildElement("attr"); attr != nullptr;
         attr = attr->NextSiblingElement("attr")) {
        const char* text = attr->GetText();
        if (attr->Attribute("key", key) != nullptr && text != nullptr) return text;
    }
    return {};
}

std::optional<Geometry> geometry_of(const tinyxml2::XMLElement& stream) {
    for (const auto* node = stream.FirstChildElement("node"); node != nullptr;
         node = node->NextSiblingElement("node")) {
        Geometry geometry;
        if (node->Attribute("name", "info") != nullptr &&
            parse(attribute(*node, "sizeX"), geometry.width) &&
            parse(attribute(*node, "sizeY"), geometry.height) && geometry.width > 0 &&
            geometry.height > 0) {
            return geometry;
        }
    }
    return {};
}

/// The table, which must lie aligned; null where it is damaged. Some versions of DV align it with
/// the size before it, others without.
const aedat4::Header* verified_header(std::vector<std::uint8_t>& bytes) {
    if (flatbuffers::Verifier(bytes.data(), bytes.size())
            .VerifySizePrefixedBuffer<aedat4::Header>("IOHE")) {
        return flatbuffers::GetSizePrefixedRoot<aedat4::Header>(bytes.data());
    }
    bytes.erase(bytes.begin(), bytes.begin() + 4);
    if (flatbuffers::Verifier(bytes.data(), bytes.size()).VerifyBuffer<aedat4::Header>("IOHE")) {
        return flatbuffers::GetRoot<aedat4::Header>(bytes.data());
    }
    return nullptr;
}

/// <dv><node name="outInfo"><node name="0">…: one node a stream, its name the stream's id.
Result<void> read_streams(const char* info, Aedat4Header& header) {
    tinyxml2::XMLDocument document;
    if (document.Parse(info) != tinyxml2::XML_SUCCESS) {
        return fail("the description of the streams is no XML");
    }
    auto& streams = header.streams;
    const auto* out_info = tinyxml2::XMLConstHandle(document)
                               .FirstChildElement("dv")
                               .FirstChildElement("node")
                               .ToElement();
    for (const auto* node = out_info == nullptr ? nullptr : out_info->FirstChildElement("node");
         node != nullptr; node = node->NextSiblingElement("node")) {
        const char* name = node->Attribute("name");
        Aedat4Header::EventStream stream;
        if (name == nullptr || !parse(std::string_view(name), stream.id)) continue;
        header.described.insert(stream.id);
        if (attribute(*node, "typeIdentifier") != "EVTS" || streams.size() == most_streams)
            continue;
        stream.geometry = geometry_of(*node);
        streams.push_back(stream);
    }
    if (streams.empty()) return fail("no stream of events is described");
    std::sort(streams.begin(), streams.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    return {};
}

}  // namespace

Result<Aedat4Header> read_aedat4_header(ByteWindow& bytes) {
    const auto fault = [&](std::size_t byte, const std::string& cause) {
        return tl::unexpected(error_at(bytes.name(), byte, cause));
    };
    const auto start = bytes.ahead(aedat4_magic.size() + 4);
    if (!start) return tl::unexpected(start.error());
    const std::string_view text(reinterpret_cast<const char*>(start->data()), start->size());
    if (text.substr(0, aedat4_magic.size()) != aedat4_magic) {
        return fault(0, "does not begin with \"#!AER-DAT4.0\"");
    }
    if (text.size() < aedat4_magic.size() + 4) return fault(text.size(), "the file ends here");
    const auto size = load<std::uint32_t>(start->data() + aedat4_magic.size());
    if (size > most_header_bytes) {
        return fault(aedat4_magic.size(), "a header of " + std::to_string(size) +
                                              " bytes, at most " +
                                              std::to_string(most_header_bytes) + " are read");
    }
    bytes.consume(aedat4_magic.size());
    const auto all = bytes.ahead(4 + size);
    if (!all) return tl::unexpected(all.error());
    if (all->size() < 4 + size) {
        return fault(aedat4_magic.size(), "the file ends within its header, after " +
                                              std::to_string(all->size()) + " of " +
                                              std::to_string(4 + size) + " bytes");
    }
    std::vector<std::uint8_t> copy(all->begin(), all->begin() + 4 + size);
    const auto* stored = verified_header(copy);
    if (stored == nullptr) return fault(aedat4_magic.size(), "the header is damaged");
    Aedat4Header header;
    switch (stored->compression()) {
        case aedat4::Compression_none:
            break;
        case aedat4::Compression_lz4:
        case aedat4::Compression_lz4_high:
            header.compression = Aedat4Header::Compression::lz4;
            break;
        case aedat4::Compression_zstd:
        case aedat4::Compression_zstd_high:
            header.compression = Aedat4Header::Compression::zstd;
            break;
        default:
            return fault(
                aedat4_magic.size(),
                "compression of kind " + std::to_string(stored->compression()) + " is unknown");
    }
    if (stored->data_table_position() > 0) header.packets_end = stored->data_table_position();
    if (stored->info() == nullptr) {
        return fault(aedat4_magic.size(), "the header does not describe its streams");
    }
    if (auto ok = read_streams(stored->info()->c_str(), header); !ok) {
        return fault(aedat4_magic.size(), ok.error().message);
    }
    bytes.consume(4 + size);
    return header;
}

}  // namespace pursuit::sensor
