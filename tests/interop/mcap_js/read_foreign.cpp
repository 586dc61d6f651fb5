// SPDX-License-Identifier: Apache-2.0
//
// read_foreign FILE MESSAGES: reads a file that write_foreign.mjs wrote, in every way we have, and
// exits with 0 when it holds that many messages, whole and in order.

#include <iostream>

#include "services/recorder/mcap/info.hpp"
#include "services/recorder/mcap/time_order.hpp"

namespace pursuit::recorder::mcap {
namespace {

/// The messages a reader gives before its end; -1 after a fault, which is printed.
template <class AnyReader>
int count(Result<AnyReader> reader, bool in_time_order) {
    int messages = 0;
    std::int64_t last_ns = 0;
    while (reader) {
        const auto message = reader->next();
        if (!message) {
            std::cerr << message.error().message << "\n";
            return -1;
        }
        if (!*message) return messages;
        const auto& view = **message;
        const auto number = static_cast<std::uint32_t>(view.data[4] | view.data[5] << 8);
        const bool ordered = in_time_order
                                 ? view.head.log_time_ns >= last_ns
                                 : view.head.sequence == static_cast<std::uint32_t>(messages);
        if (number != view.head.sequence || !ordered) {
            std::cerr << "message " << messages << " is not the one that was written\n";
            return -1;
        }
        last_ns = view.head.log_time_ns;
        ++messages;
    }
    std::cerr << reader.error().message << "\n";
    return -1;
}

bool read(const std::string& path, int messages) {
    const auto input = [&] { return *FileInput::open(path); };
    bool good = count(Reader::open(input(), path), false) == messages;
    std::uint64_t chunks = 0;
    for (const auto depth : {InfoDepth::summary, InfoDepth::full}) {
        const auto info = read_info(input(), path, depth);
        if (!info) {
            std::cerr << info.error().message << "\n";
            return false;
        }
        std::cout << to_text(*info);
        good = good && info->condition == Condition::closed && info->faults.empty() &&
               info->messages == static_cast<std::uint64_t>(messages) && info->channels.size() == 2;
        chunks = info->chunks;
    }
    // Messages outside chunks cannot be sorted, which is said.
    if (chunks > 0) good = good && count(TimeOrderedReader::open(input(), path), true) == messages;
    return good;
}

}  // namespace
}  // namespace pursuit::recorder::mcap

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: read_foreign FILE MESSAGES\n";
        return 2;
    }
    const bool good = pursuit::recorder::mcap::read(argv[1], std::stoi(argv[2]));
    std::cout << (good ? "ok      " : "FAILED  ") << argv[1] << "\n";
    return good ? 0 : 1;
}
