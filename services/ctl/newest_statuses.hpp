// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace pursuit::ctl {

/// The newest status of every service of one kind, by its instance. One that has told nothing for
/// silent_after is gone: each tells its own every second.
///
/// A service that was started again has another writer. Which of two came later is told by when
/// they were heard first, and not by a time that they state: clocks are set. Threads: one at a
/// time.
template <class Status, class Writer>
class NewestStatuses {
 public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr std::chrono::seconds silent_after{3};

    void put(const std::string& instance, const Status& status, const Writer& writer, Time now) {
        forget_silent(now);
        const auto [place, first] = newest_.try_emplace(instance, Entry{status, writer, {}, now});
        if (first) return;
        auto& known = place->second;
        // A killed service's last words may come after its successor's first.
        if (writer == known.predecessor) return;
        if (writer != known.writer) known.predecessor = known.writer;
        known.status = status;
        known.writer = writer;
        known.heard = now;
    }

    /// Of those that are there.
    std::map<std::string, Status> at(Time now) {
        forget_silent(now);
        std::map<std::string, Status> statuses;
        for (const auto& [instance, entry] : newest_) statuses.emplace(instance, entry.status);
        return statuses;
    }

 private:
    struct Entry {
        Status status;
        Writer writer;
        Writer predecessor;  ///< A default one: none is known.
        Time heard;
    };

    void forget_silent(Time now) {
        std::erase_if(newest_,
                      [&](const auto& each) { return now - each.second.heard >= silent_after; });
    }

    std::map<std::string, Entry> newest_;
};

}  // namespace pursuit::ctl
