// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/csv_writer.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "services/common/output_file.hpp"

namespace pursuit::sensor {
namespace {

class CsvWriter final : public EventWriter {
 public:
    CsvWriter(OutputFile file, Geometry geometry)
        : EventWriter(file.path(), geometry), file_(std::move(file)) {}

    Result<void> write_header() {
        return file_.write("# geometry " + std::to_string(geometry().width) + "x" +
                           std::to_string(geometry().height) + "\nt_us,x,y,p\n");
    }

    Result<void> close() override { return file_.close(); }

 protected:
    Result<void> encode(const Event& event, bool /*is_exposure*/) override {
        std::array<char, 48> line;  // 19 + 5 + 5 + 1 digits, three commas, an end
        char* at = line.data();
        const auto append = [&](auto number, char separator) {
            at = std::to_chars(at, line.data() + line.size() - 1, number).ptr;
            *at++ = separator;
        };
        append(event.t_us, ',');
        append(event.x, ',');
        append(event.y, ',');
        append(unsigned{event.polarity}, '\n');
        return file_.write({line.data(), static_cast<std::size_t>(at - line.data())});
    }

 private:
    OutputFile file_;
};

}  // namespace

Result<std::unique_ptr<EventWriter>> create_csv(const std::string& path, Geometry geometry,
                                                bool /*exposures*/) {
    if (geometry.width < 1 || geometry.height < 1) return fail(path + ": without pixels");
    auto file = OutputFile::create(path);
    if (!file) return tl::unexpected(file.error());
    auto writer = std::make_unique<CsvWriter>(std::move(*file), geometry);
    if (auto ok = writer->write_header(); !ok) return tl::unexpected(ok.error());
    return writer;
}

}  // namespace pursuit::sensor
