// SPDX-License-Identifier: Apache-2.0
#include "services/common/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <string>

namespace pursuit {
namespace {

/// sd-daemon(3): the priority as a prefix in angle brackets.
class JournalPriority : public spdlog::custom_flag_formatter {
 public:
    void format(const spdlog::details::log_msg& message, const std::tm&,
                spdlog::memory_buf_t& out) override {
        const char* priority = "<6>";
        switch (message.level) {
            case spdlog::level::trace:
            case spdlog::level::debug:
                priority = "<7>";
                break;
            case spdlog::level::warn:
                priority = "<4>";
                break;
            case spdlog::level::err:
                priority = "<3>";
                break;
            case spdlog::level::critical:
                priority = "<2>";
                break;
            default:
                break;
        }
        out.append(priority, priority + 3);
    }
    std::unique_ptr<custom_flag_formatter> clone() const override {
        return spdlog::details::make_unique<JournalPriority>();
    }
};

/// systemd.exec(5): standard error is the journal when JOURNAL_STREAM names its device and inode.
bool stderr_is_journal() {
    const char* stream = std::getenv("JOURNAL_STREAM");
    struct stat facts {};
    if (stream == nullptr || ::fstat(STDERR_FILENO, &facts) != 0) return false;
    return std::to_string(facts.st_dev) + ":" + std::to_string(facts.st_ino) == stream;
}

class MiddlewareLog : public eprosima::fastdds::dds::LogConsumer {
 public:
    void Consume(const eprosima::fastdds::dds::Log::Entry& entry) override {
        const bool error = entry.kind == eprosima::fastdds::dds::Log::Kind::Error;
        spdlog::log(error ? spdlog::level::warn : spdlog::level::debug, "DDS {}: {}",
                    entry.context.category != nullptr ? entry.context.category : "", entry.message);
    }
};

}  // namespace

void start_log(const disk::Log& settings) {
    auto logger = std::make_shared<spdlog::logger>(
        "pursuit", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    if (stderr_is_journal()) {
        formatter->add_flag<JournalPriority>('*').set_pattern("%*%v");
    } else {
        formatter->set_pattern("%H:%M:%S.%e %l %v");
    }
    logger->set_formatter(std::move(formatter));
    switch (settings.level()) {
        case disk::Log::DEBUG:
            logger->set_level(spdlog::level::debug);
            break;
        case disk::Log::INFO:
            logger->set_level(spdlog::level::info);
            break;
        case disk::Log::WARNING:
            logger->set_level(spdlog::level::warn);
            break;
        case disk::Log::ERROR:
            logger->set_level(spdlog::level::err);
            break;
    }
    logger->flush_on(spdlog::level::debug);
    spdlog::set_default_logger(std::move(logger));

    using Log = eprosima::fastdds::dds::Log;
    Log::ClearConsumers();
    Log::SetVerbosity(Log::Kind::Error);
    Log::RegisterConsumer(std::make_unique<MiddlewareLog>());
}

}  // namespace pursuit
