// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/formats.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "services/sensor/formats/aedat2_reader.hpp"
#include "services/sensor/formats/aedat4_reader.hpp"
#include "services/sensor/formats/csv_reader.hpp"
#include "services/sensor/formats/csv_writer.hpp"
#include "services/sensor/formats/dat_reader.hpp"
#include "services/sensor/formats/dat_writer.hpp"
#include "services/sensor/formats/es_reader.hpp"
#include "services/sensor/formats/es_writer.hpp"
#include "services/sensor/formats/nmnist_reader.hpp"
#include "services/sensor/formats/raw_reader.hpp"
#include "services/sensor/formats/rpg_text_reader.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t head_bytes = 4096;
constexpr std::string_view mcap_begin = "\x89MCAP";

constexpr Format table[] = {
    {"dat", "DAT, 1 and 2, of ATIS cameras", {".dat"}, looks_like_dat, open_dat, create_dat},
    {"es", "Event Stream 2, DVS and ATIS", {".es"}, looks_like_es, open_es, create_es},
    {"raw", "Prophesee RAW, as its header says", {".raw"}, looks_like_raw, open_raw, nullptr},
    {"evt2", "the words of EVT2, header or not", {}, nullptr, open_evt2, nullptr},
    {"evt21", "the words of EVT2.1, header or not", {}, nullptr, open_evt21, nullptr},
    {"evt3", "the words of EVT3, header or not", {}, nullptr, open_evt3, nullptr},
    {"nmnist", "40 bits an event, of N-MNIST", {".bin"}, nullptr, open_nmnist, nullptr},
    {"aedat2", "AEDAT 2.0, of jAER", {".aedat"}, looks_like_aedat2, open_aedat2, nullptr},
    {"aedat4", "AEDAT 4, of DV", {".aedat4"}, looks_like_aedat4, open_aedat4, nullptr},
    {"csv", "CSV: t_us,x,y,p a line", {".csv"}, looks_like_csv, open_csv, create_csv},
    {"rpg", "text: t_s x y p a line", {".txt"}, looks_like_rpg_text, open_rpg_text, nullptr},
};

std::string names_of(std::span<const Format* const> list) {
    std::string names;
    for (const auto* format : list)
        names += (names.empty() ? "" : ", ") + std::string(format->name);
    return names;
}

std::vector<const Format*> all_formats() {
    std::vector<const Format*> all;
    for (const auto& format : table) all.push_back(&format);
    return all;
}

Result<const Format*> format_named(const std::string& name) {
    for (const auto& format : table) {
        if (format.name == name) return &format;
    }
    return fail("no format is named \"" + name + "\"; there are " + names_of(all_formats()));
}

std::vector<const Format*> by_extension(const std::string& path) {
    auto extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::vector<const Format*> found;
    for (const auto& format : table) {
        const auto& known = format.extensions;
        if (!extension.empty() && std::find(known.begin(), known.end(), extension) != known.end()) {
            found.push_back(&format);
        }
    }
    return found;
}

}  // namespace

std::span<const Format> formats() { return table; }

Result<const Format*> find_format(const std::string& path, std::string_view head) {
    auto candidates = by_extension(path);
    if (candidates.size() == 1) return candidates.front();
    if (candidates.empty()) candidates = all_formats();
    std::erase_if(candidates, [&](const Format* format) {
        return format->recognises == nullptr || !format->recognises(head);
    });
    if (candidates.empty() && head.substr(0, mcap_begin.size()) == mcap_begin) {
        return fail(path + ": is an MCAP recording, of topics: use info or replay");
    }
    if (candidates.empty()) {
        return fail(path + ": is in no known format (" + names_of(all_formats()) + ")");
    }
    if (candidates.size() > 1) {
        return fail(path + ": could be in more than one format (" + names_of(candidates) +
                    "): name one");
    }
    return candidates.front();
}

Result<std::unique_ptr<EventReader>> open_events(std::unique_ptr<ByteSource> source,
                                                 const ReadOptions& options) {
    ByteWindow bytes(std::move(source));
    // A live stream's format is named: then one byte is all that is waited for.
    const auto head = bytes.ahead(options.format.empty() ? head_bytes : 1);
    if (!head) return tl::unexpected(head.error());
    if (head->empty()) return tl::unexpected(error_at(bytes.name(), 0, "the file is empty"));
    const std::string_view text(reinterpret_cast<const char*>(head->data()),
                                std::min(head->size(), head_bytes));
    const auto format =
        options.format.empty() ? find_format(bytes.name(), text) : format_named(options.format);
    if (!format) return tl::unexpected(format.error());
    return (*format)->open(std::move(bytes), options);
}

Result<std::unique_ptr<EventReader>> open_events(const std::string& path,
                                                 const ReadOptions& options) {
    auto source = open_file(path);
    if (!source) return tl::unexpected(source.error());
    return open_events(std::move(*source), options);
}

Result<std::unique_ptr<EventWriter>> create_events(const std::string& path, Geometry geometry,
                                                   bool exposures) {
    auto candidates = by_extension(path);
    std::erase_if(candidates, [](const Format* format) { return format->create == nullptr; });
    if (candidates.empty()) {
        auto writable = all_formats();
        std::erase_if(writable, [](const Format* format) { return format->create == nullptr; });
        std::string extensions;
        for (const auto* format : writable) {
            extensions += (extensions.empty() ? "" : ", ") + std::string(format->extensions[0]);
        }
        return fail(path + ": no format that can be written has this extension (" + extensions +
                    " can)");
    }
    return candidates.front()->create(path, geometry, exposures);
}

}  // namespace pursuit::sensor
