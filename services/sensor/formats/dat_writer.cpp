// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/dat_writer.hpp"

#include <cstring>
#include <utility>

#include "services/common/output_file.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::int64_t wrap_us = std::int64_t{1} << 32;
constexpr int largest_written_side = 1 << 14;

class DatWriter final : public EventWriter {
 public:
    DatWriter(OutputFile file, Geometry geometry)
        : EventWriter(file.path(), geometry), file_(std::move(file)) {}

    Result<void> write_header() {
        return file_.write("% Data file containing CD events.\n% Version 2\n% Height " +
                           std::to_string(geometry().height) + "\n% Width " +
                           std::to_string(geometry().width) + "\n\x0c\x08");
    }

    Result<void> close() override { return file_.close(); }

 protected:
    Result<void> encode(const Event& event, bool /*is_exposure*/) override {
        const bool wraps = event.t_us / wrap_us != last_t_us() / wrap_us;
        if (wraps && event.t_us - last_t_us() >= wrap_us / 2) {
            return fail(name() + ": DAT cannot hold the step of time from " +
                        std::to_string(last_t_us()) + " to " + std::to_string(event.t_us) + " us");
        }
        const std::uint32_t words[2] = {static_cast<std::uint32_t>(event.t_us),
                                        event.x | static_cast<std::uint32_t>(event.y) << 14 |
                                            static_cast<std::uint32_t>(event.polarity) << 28};
        char bytes[sizeof words];
        std::memcpy(bytes, words, sizeof words);
        return file_.write({bytes, sizeof bytes});
    }

 private:
    OutputFile file_;
};

}  // namespace

Result<std::unique_ptr<EventWriter>> create_dat(const std::string& path, Geometry geometry,
                                                bool /*exposures*/) {
    if (geometry.width < 1 || geometry.height < 1 || geometry.width > largest_written_side ||
        geometry.height > largest_written_side) {
        return fail(path + ": DAT cannot hold " + std::to_string(geometry.width) + "x" +
                    std::to_string(geometry.height) + " pixels");
    }
    auto file = OutputFile::create(path);
    if (!file) return tl::unexpected(file.error());
    auto writer = std::make_unique<DatWriter>(std::move(*file), geometry);
    if (auto ok = writer->write_header(); !ok) return tl::unexpected(ok.error());
    return writer;
}

}  // namespace pursuit::sensor
