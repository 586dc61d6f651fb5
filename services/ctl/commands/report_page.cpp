// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/common/output_file.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/recording/recorded_run.hpp"
#include "services/ctl/recording/run_report.hpp"
#include "services/ctl/report/report.hpp"

namespace pursuit::ctl {
namespace {

struct ReportOptions {
    std::string recording;
    std::string truth;
    std::string output = "pursuit-report.html";
    std::string title = "Pursuit";
    std::size_t slices = 16;
    double slice_ms = 20;
    bool check = false;
};

void print_summary(const Report& page, const std::vector<std::string>& faults) {
    for (const auto& object : page.objects) {
        std::printf("%-12s %6zu poses  ", object.name.c_str(), object.poses.size());
        if (object.mean_error_px) std::printf("E %.2f px  ", *object.mean_error_px);
        std::printf("%s\n", verdict(object).text.c_str());
    }
    for (const auto& count : page.counts) {
        if (count.is_loss) {
            std::printf("%-34s %llu\n", count.name.c_str(),
                        static_cast<unsigned long long>(count.count));
        }
    }
    for (const auto& fault : faults) std::printf("recording: %s\n", fault.c_str());
    std::printf("%s\n", verdict(page).text.c_str());
}

int write_report(const ReportOptions& options) {
    for (const auto& input : {options.recording, options.truth}) {
        if (auto ok = check_is_not_input(options.output, input); !ok) return report(ok.error());
    }
    const auto recorded = read_run(options.recording, options.slices,
                                   static_cast<std::int64_t>(options.slice_ms * 1000));
    if (!recorded) return report(recorded.error());
    std::vector<ObjectRows> truth;
    if (!options.truth.empty()) {
        auto read = read_object_rows(options.truth);
        if (!read) return report(read.error());
        truth = std::move(*read);
    }
    const auto page = make_report(*recorded, truth, options.title);
    if (auto written = write_report(options.output, page); !written) return report(written.error());
    print_summary(page, recorded->faults);
    return options.check && !verdict(page).good ? exit_failure : exit_success;
}

}  // namespace

Run define_report(CLI::App& app) {
    auto options = std::make_shared<ReportOptions>();
    app.add_option("recording", options->recording, "Recording of the services, MCAP")->required();
    app.add_option("--truth", options->truth, "Table of truth, CSV: adds errors");
    app.add_option("--output", options->output, "The page, HTML")->capture_default_str();
    app.add_option("--title", options->title, "Its title")->capture_default_str();
    app.add_option("--slices", options->slices, "Pictures of events with outlines")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
    app.add_option("--slice-ms", options->slice_ms, "Events in a picture, ms")
        ->check(finite_range(0.1, 1000))
        ->capture_default_str();
    app.add_flag("--check", options->check,
                 "Exit code 1 unless every object was tracked to the end and nothing was lost");
    return [options] { return write_report(*options); };
}

}  // namespace pursuit::ctl
