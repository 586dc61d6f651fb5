// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pursuit::recorder::mcap {

/// How a file ends.
enum class Condition {
    reading,     ///< Not at its end yet.
    closed,      ///< By its writer; every CRC is right.
    not_closed,  ///< After a whole record, without a summary: the writer was killed or still
                 ///< writes.
    cut,         ///< Inside a record: the writer was killed while it wrote, or the file was cut.
    damaged,     ///< A place says what it cannot say, or a CRC is wrong.
    unreadable,  ///< The disk gave an error.
};

/// "closed cleanly", "damaged", ….
std::string_view name_of(Condition condition);

/// What was found wrong, and where.
struct Fault {
    Condition condition = Condition::damaged;
    std::uint64_t offset = 0;  ///< Of the record, bytes from the start of the file.
    std::string cause;
};

/// "run.mcap: byte 4711: the chunk's CRC is …".
std::string to_string(const Fault& fault, const std::string& file_name);

enum class OnDamage {
    stop,        ///< The first fault ends the reading.
    skip_chunk,  ///< A chunk that is damaged inside is left out, reading goes on after it.
};

/// What is wrong with a file that is being read, and whether its reading goes on. Threads: one.
///
///   reading ─► closed (sound) | damaged (to its end, with faults noted before)
///       └────► not_closed | cut | damaged | unreadable (by end())
class FaultLog {
 public:
    explicit FaultLog(OnDamage on_damage) : on_damage_(on_damage) {}

    /// Nothing behind this fault can be read.
    void end(Fault fault);
    /// Reading goes on.
    void note(Fault fault);
    /// Damage that end()s or is note()d, as OnDamage has it.
    void damage(std::uint64_t offset, std::string cause);
    /// The file was read to its end.
    void close() { condition_ = faults_.empty() ? Condition::closed : Condition::damaged; }

    Condition condition() const { return condition_; }
    OnDamage on_damage() const { return on_damage_; }

    /// In the order of the file; the first 100.
    const std::vector<Fault>& faults() const { return faults_; }

 private:
    OnDamage on_damage_;
    Condition condition_ = Condition::reading;
    std::vector<Fault> faults_;
};

}  // namespace pursuit::recorder::mcap
