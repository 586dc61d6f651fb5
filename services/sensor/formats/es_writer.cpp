// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/es_writer.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "services/common/output_file.hpp"
#include "services/sensor/formats/es_layout.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::int64_t longest_step_us = std::int64_t{1} << 32;

template <class Kind>
class EsWriter final : public EventWriter {
 public:
    EsWriter(OutputFile file, Geometry geometry)
        : EventWriter(file.path(), geometry), file_(std::move(file)) {}

    bool holds_exposures() const override { return Kind::has_exposures; }

    Result<void> write_header() {
        const auto size = geometry();
        char header[es::header_bytes] = {};
        std::copy(es::magic.begin(), es::magic.end(), header);
        header[es::version_at] = 2;
        header[es::type_at] = static_cast<char>(Kind::type);
        std::memcpy(header + es::size_at, &size.width, sizeof size.width);
        std::memcpy(header + es::size_at + 2, &size.height, sizeof size.height);
        return file_.write({header, sizeof header});
    }

    Result<void> close() override { return file_.close(); }

 protected:
    Result<void> encode(const Event& event, bool is_exposure) override {
        const auto step_us = event.t_us - last_t_us();
        if (step_us >= longest_step_us) {
            return fail(name() + ": Event Stream cannot hold the step of time from " +
                        std::to_string(last_t_us()) + " to " + std::to_string(event.t_us) + " us");
        }
        for (auto units = step_us / Kind::unit_us; units > 0; units -= Kind::most_units) {
            const char byte = static_cast<char>(Kind::no_units | std::min(units, Kind::most_units));
            if (auto ok = file_.write({&byte, 1}); !ok) return ok;
        }
        const auto y = static_cast<std::uint16_t>(geometry().height - 1 - event.y);
        char bytes[es::event_bytes];
        bytes[0] =
            static_cast<char>(Kind::first(step_us % Kind::unit_us, event.polarity, is_exposure));
        std::memcpy(bytes + 1, &event.x, sizeof event.x);
        std::memcpy(bytes + 3, &y, sizeof y);
        return file_.write({bytes, sizeof bytes});
    }

 private:
    OutputFile file_;
};

template <class Kind>
Result<std::unique_ptr<EventWriter>> create(OutputFile file, Geometry geometry) {
    auto writer = std::make_unique<EsWriter<Kind>>(std::move(file), geometry);
    if (auto ok = writer->write_header(); !ok) return tl::unexpected(ok.error());
    return writer;
}

}  // namespace

Result<std::unique_ptr<EventWriter>> create_es(const std::string& path, Geometry geometry,
                                               bool exposures) {
    if (geometry.width < 1 || geometry.height < 1) return fail(path + ": without pixels");
    auto file = OutputFile::create(path);
    if (!file) return tl::unexpected(file.error());
    return exposures ? create<es::Atis>(std::move(*file), geometry)
                     : create<es::Dvs>(std::move(*file), geometry);
}

}  // namespace pursuit::sensor
