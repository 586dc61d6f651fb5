// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "services/common/reader.hpp"
#include "services/common/topics.hpp"
#include "services/ctl/commands/dds_commands.hpp"
#include "services/ctl/commands/dds_options.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/live_poses.hpp"

namespace pursuit::ctl {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr auto settling = 250ms;

struct PosesOptions {
    DdsOptions dds;
    std::string csv;
    bool json = false;
    bool strict = false;
    std::string model;
    std::uint64_t count = 0;
    double for_s = 0;
    bool to_csv = false;
};

volatile sig_atomic_t interrupted = 0;

/// Even where a shell has told its background jobs to ignore the interrupt.
void catch_interrupt() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

/// Samples between the middleware's thread and this one; beyond a million the newest is left out
/// and counted.
class Inbox {
 public:
    void put(v1::ObjectPose& pose) {
        {
            const std::scoped_lock lock(mutex_);
            if (waiting_.size() >= capacity) {
                ++dropped_;
                return;
            }
            waiting_.push_back(pose);
        }
        changed_.notify_one();
    }
    std::deque<v1::ObjectPose> take(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [&] { return !waiting_.empty(); });
        return std::exchange(waiting_, {});
    }
    std::uint64_t dropped() {
        const std::scoped_lock lock(mutex_);
        return dropped_;
    }

 private:
    static constexpr std::size_t capacity = 1'000'000;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<v1::ObjectPose> waiting_;
    std::uint64_t dropped_ = 0;
};

/// Where poses are written to, one way or another. Every write is checked.
class Output {
 public:
    static Result<Output> open(const PosesOptions& options) {
        Output output(options);
        if (!options.to_csv) return output;
        if (!options.csv.empty()) {
            std::FILE* file = std::fopen(options.csv.c_str(), "we");
            if (file == nullptr) {
                return fail(options.csv + ": cannot create: " + std::strerror(errno));
            }
            output.file_ = file;
        }
        output.write(pose_csv_header);
        output.flush();
        return output;
    }
    Output(Output&& other) noexcept
        : options_(other.options_),
          file_(std::exchange(other.file_, stdout)),
          good_(other.good_),
          table_(std::move(other.table_)) {}
    Output& operator=(Output&&) = delete;
    ~Output() {
        if (file_ != stdout) std::fclose(file_);
    }

    void add(const v1::ObjectPose& pose) {
        if (options_.to_csv) {
            line_.clear();
            append_pose_csv(line_, row_of(pose));
            write(line_);
        } else if (options_.json) {
            write(pose_json(pose) + "\n");
        } else {
            table_.add(pose);
        }
    }
    /// Of a batch; of the table, about ten times a second on a terminal, else once a second.
    void flush() {
        if (!options_.to_csv && !options_.json && table_.due(SteadyClock::now())) {
            write(table_.text());
        }
        good_ = std::fflush(file_) == 0 && good_;
    }
    [[nodiscard]] bool good() const { return good_; }

 private:
    explicit Output(const PosesOptions& options)
        : options_(options), table_(::isatty(STDOUT_FILENO) == 1) {}
    void write(std::string_view text) {
        good_ = std::fwrite(text.data(), 1, text.size(), file_) == text.size() && good_;
    }

    const PosesOptions& options_;
    std::FILE* file_ = stdout;
    bool good_ = true;
    PoseTable table_;
    std::string line_;
};

int finish(const PosesOptions& options, const PoseCounter& counter, std::uint64_t dropped,
           std::uint64_t shown, bool good) {
    std::fprintf(stderr, "%llu poses; %llu gaps, %llu poses missed\n",
                 static_cast<unsigned long long>(counter.poses()),
                 static_cast<unsigned long long>(counter.gaps()),
                 static_cast<unsigned long long>(counter.missed() + dropped));
    if (!good) return report(Error{"the poses could not be written"});
    if (shown < options.count) {
        return report(Error{"only " + std::to_string(shown) + " of " +
                            std::to_string(options.count) + " poses came"});
    }
    if (shown == 0 && interrupted == 0) return report(Error{"no pose came " + where(options.dds)});
    const bool whole = counter.missed() + dropped == 0;
    return options.strict && !whole ? report(Error{"poses were missed"}) : exit_success;
}

int poses(const PosesOptions& options) {
    catch_interrupt();
    auto participant = join(options.dds);
    if (!participant) return report(participant.error());
    Inbox inbox;
    auto reader = Reader<v1::ObjectPose>::create(
        **participant, topic::poses,
        [&inbox](v1::ObjectPose& pose, const auto&) { inbox.put(pose); });
    if (!reader) return report(reader.error());
    const auto begin = SteadyClock::now();
    while ((*reader)->matched() == 0 && interrupted == 0) {
        if (SteadyClock::now() - begin > options.dds.timeout()) {
            return report(Error{"nobody publishes poses " + where(options.dds) + " within " +
                                std::to_string(options.dds.timeout_ms) + " ms"});
        }
        std::this_thread::sleep_for(2ms);
    }
    // The writer learns of this reader later than this reader of the writer: only then is the head
    // of the table written, by which others see that every pose from here on is heard.
    const auto settled = SteadyClock::now() + settling;
    while (SteadyClock::now() < settled && interrupted == 0) std::this_thread::sleep_for(2ms);
    auto output = Output::open(options);
    if (!output) return report(output.error());
    PoseCounter counter;
    std::uint64_t shown = 0;
    const auto end = options.for_s > 0 ? begin + std::chrono::duration_cast<SteadyClock::duration>(
                                                     std::chrono::duration<double>(options.for_s))
                                       : SteadyClock::time_point::max();
    const auto enough = [&] { return options.count > 0 && shown >= options.count; };
    while (interrupted == 0 && output->good() && !enough() && SteadyClock::now() < end) {
        for (const auto& pose : inbox.take(50ms)) {
            counter.add(pose);
            if (!options.model.empty() && pose.model().to_string() != options.model) continue;
            output->add(pose);
            ++shown;
            if (enough()) break;
        }
        output->flush();
    }
    return finish(options, counter, inbox.dropped(), shown, output->good());
}

}  // namespace

Run define_poses(CLI::App& app) {
    auto options = std::make_shared<PosesOptions>();
    add_dds_options(app, options->dds);
    auto* csv = app.add_option("--csv", options->csv,
                               "As a table with the columns of `track`, to this file or, without "
                               "one, to standard output")
                    ->expected(0, 1);
    app.add_flag("--json", options->json, "One JSON object a line")->excludes(csv);
    app.add_option("--model", options->model, "Of this model alone");
    app.add_option("--count", options->count, "End after so many poses; 0: never")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--for", options->for_s, "End after so many seconds; 0: never")
        ->check(finite_range(0, 1e9));
    app.add_flag("--strict", options->strict, "Fail when a pose was missed");
    return [options, csv] {
        options->to_csv = csv->count() > 0;
        return poses(*options);
    };
}

}  // namespace pursuit::ctl
