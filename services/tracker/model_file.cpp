// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/model_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "model.pb.h"
#include "services/common/csv.hpp"
#include "services/common/text_format.hpp"

namespace pursuit::tracker {
namespace {

std::string name_of(const std::filesystem::path& path) {
    auto name = path.stem().string();
    for (const std::string prefix : {"model_true_", "model_"}) {
        if (name.starts_with(prefix)) return name.substr(prefix.size());
    }
    return name;
}

bool is_csv(const std::filesystem::path& path) { return path.extension() == ".csv"; }

std::filesystem::path edges_path_of(std::filesystem::path path) {
    return path.replace_filename(path.stem().string() + "_edges.csv");
}

/// Hands each row's two numbers to `take`.
template <class Number, class Take>
Result<void> read_pairs(const std::string& path, const char* first, const char* second, Take take) {
    auto table = CsvReader::open(path);
    if (!table) return tl::unexpected(table.error());
    const auto first_column = table->required_column(first);
    if (!first_column) return tl::unexpected(first_column.error());
    const auto second_column = table->required_column(second);
    if (!second_column) return tl::unexpected(second_column.error());
    for (;;) {
        const auto more = table->next();
        if (!more) return tl::unexpected(more.error());
        if (!*more) return {};
        const auto a = table->template number<Number>(*first_column);
        if (!a) return tl::unexpected(a.error());
        const auto b = table->template number<Number>(*second_column);
        if (!b) return tl::unexpected(b.error());
        if (!take(*a, *b)) return fail(table->where() + ": more rows than a model may have");
    }
}

Result<Shape> read_csv(const std::filesystem::path& path) {
    Shape shape;
    shape.name = name_of(path);
    const auto points =
        read_pairs<float>(path.string(), "x_px", "y_px", [&](float x_px, float y_px) {
            shape.points_px.emplace_back(x_px, y_px);
            return shape.points_px.size() <= max_shape_points;
        });
    if (!points) return tl::unexpected(points.error());
    const auto edges_path = edges_path_of(path);
    std::error_code error;
    if (!std::filesystem::exists(edges_path, error)) return shape;
    const auto edges = read_pairs<std::uint16_t>(edges_path.string(), "from", "to",
                                                 [&](std::uint16_t from, std::uint16_t to) {
                                                     shape.edges.push_back({from, to});
                                                     return shape.edges.size() <= max_shape_edges;
                                                 });
    if (!edges) return tl::unexpected(edges.error());
    return shape;
}

Result<ModelFile> read_text(const std::string& path, FieldPlaces& places) {
    disk::Model message;
    if (auto ok = read_text_file(path, message, &places); !ok) return tl::unexpected(ok.error());
    ModelFile model;
    model.shape.name = message.name();
    for (const auto& point : message.point()) {
        model.shape.points_px.emplace_back(point.x_px(), point.y_px());
    }
    for (const auto& edge : message.edge()) {
        model.shape.edges.push_back(
            {static_cast<std::uint16_t>(edge.from()), static_cast<std::uint16_t>(edge.to())});
    }
    model.comment = message.comment();
    if (message.has_origin_x_px() != message.has_origin_y_px()) {
        const Error error{"origin_x_px and origin_y_px must come together",
                          message.has_origin_x_px() ? "origin_x_px" : "origin_y_px"};
        return tl::unexpected(places.located(error, path));
    }
    if (message.has_origin_x_px()) {
        model.origin_px = Eigen::Vector2d(message.origin_x_px(), message.origin_y_px());
        if (!model.origin_px->allFinite()) return fail(path + ": the origin is not a number");
    }
    return model;
}

}  // namespace

Result<ModelFile> read_model_file(const std::string& path) {
    ModelFile model;
    FieldPlaces places;
    if (is_csv(path)) {
        auto shape = read_csv(path);
        if (!shape) return tl::unexpected(shape.error());
        model.shape = std::move(*shape);
    } else {
        auto read = read_text(path, places);
        if (!read) return read;
        model = std::move(*read);
    }
    if (auto ok = check(model.shape); !ok) {
        return tl::unexpected(places.located(ok.error(), path));
    }
    model.shape = centred(std::move(model.shape));
    return model;
}

std::vector<std::string> model_file_paths(const std::string& path) {
    std::vector<std::string> paths = {path};
    if (is_csv(path)) paths.push_back(edges_path_of(path).string());
    return paths;
}

Result<void> write_model_file(const std::string& path, const ModelFile& model) {
    if (auto ok = check(model.shape); !ok) return fail(path + ": " + ok.error().message);
    disk::Model message;
    message.set_name(model.shape.name);
    for (const auto& point : model.shape.points_px) {
        auto* added = message.add_point();
        added->set_x_px(point.x());
        added->set_y_px(point.y());
    }
    for (const auto& edge : model.shape.edges) {
        auto* added = message.add_edge();
        added->set_from(edge.from);
        added->set_to(edge.to);
    }
    if (!model.comment.empty()) message.set_comment(model.comment);
    if (model.origin_px) {
        message.set_origin_x_px(model.origin_px->x());
        message.set_origin_y_px(model.origin_px->y());
    }
    return write_text_file(path, message);
}

Result<ModelArgument> parse_model_argument(const std::string& argument) {
    const auto at = argument.rfind('@');
    ModelArgument parsed{argument.substr(0, at), {}};
    if (parsed.path.empty()) return fail(argument + ": names no file");
    if (at == std::string::npos) return parsed;

    std::array<double, 4> numbers{0, 0, 0, 1};
    std::size_t count = 0;
    std::string_view rest = std::string_view(argument).substr(at + 1);
    for (;;) {
        const auto text = rest.substr(0, rest.find(','));
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (count == numbers.size() || text.empty() || error != std::errc() ||
            end != text.data() + text.size() || !std::isfinite(value)) {
            return fail(argument + ": what follows the @ must be x,y,theta[,scale]");
        }
        numbers[count++] = value;
        if (text.size() == rest.size()) break;
        rest.remove_prefix(text.size() + 1);
    }
    if (count < 3) return fail(argument + ": what follows the @ must be x,y,theta[,scale]");
    // A negative scale would be half a turn, unseen by a check of the pose.
    if (numbers[3] <= 0) return fail(argument + ": the scale must be more than 0");
    const auto start = pose_of(numbers[0], numbers[1], numbers[2], numbers[3], numbers[3]);
    if (auto ok = check(start, TransformKind::similarity); !ok) {
        return fail(argument + ": " + ok.error().message);
    }
    parsed.start = start;
    return parsed;
}

}  // namespace pursuit::tracker
