// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/site_file.h"

#include <fmt/format.h>
#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/PointCount.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/error.h"
#include "formats/opal_asset_io.h"
#include "modeler/mesh_file.h"

namespace opal {
namespace {

/// As far as the lengths of a recipe reach; squares of distances stay far from overflowing.
constexpr double farthest_mm = 1.0e7;

using openvdb::Vec3d;

constexpr std::size_t max_sites = 50'000'000;

std::optional<double> parse_number(std::string_view field) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
    while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
    if (!field.empty() && field.front() == '+') field.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<Vec3d> parse_point(std::string_view line) {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = line.find(',');
        const std::optional<double> number = parse_number(line.substr(0, comma));
        if (!number || (comma == std::string_view::npos && axis < 2)) return std::nullopt;
        point[axis] = *number;
        line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    }
    return point;
}

bool is_header(std::string_view line) {
    return !parse_number(line.substr(0, line.find(','))) && line.find_first_of("xX") != std::string_view::npos;
}

std::vector<Vec3d> read_csv(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw InputError(fmt::format("sites {}: cannot be opened", file.string()));
    std::vector<Vec3d> points;
    std::size_t number = 0;
    bool first = true;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
        const bool header = std::exchange(first, false) && is_header(line);
        if (header) continue;
        const std::optional<Vec3d> point = parse_point(line);
        if (!point)
            throw InputError(
                fmt::format("sites {}:{}: '{}' is not x,y,z (three finite numbers)", file.string(), number, line.substr(0, 60)));
        points.push_back(*point);
    }
    return points;
}

openvdb::points::PointDataGrid::Ptr find_points(const RawOpalFile& raw, const std::string& file) {
    std::string found;
    openvdb::points::PointDataGrid::Ptr first;
    for (const auto& grid : raw.grids) {
        const auto points = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(grid);
        if (points && grid->getName() == grid_names::sites) return points;
        if (points && !first) first = points;
        found += (found.empty() ? "" : ", ") + grid->getName();
    }
    if (!first)
        throw InputError(fmt::format("sites {}: holds no grid of points (found: {})", file, found.empty() ? "no grids" : found));
    return first;
}

std::vector<Vec3d> read_point_grid(const std::filesystem::path& file) {
    namespace points = openvdb::points;
    const auto grid = find_points(read_raw_opal_file(file), file.string());
    std::vector<std::pair<std::int32_t, Vec3d>> numbered;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
        if (!leaf->hasAttribute("P"))
            throw InputError(fmt::format("sites {}: grid {}: attribute 'P' is missing", file.string(), grid->getName()));
        const points::AttributeHandle<openvdb::Vec3f> position(leaf->constAttributeArray("P"));
        std::optional<points::AttributeHandle<std::int32_t>> id;
        if (leaf->hasAttribute("id")) id.emplace(leaf->constAttributeArray("id"));
        for (auto index = leaf->beginIndexOn(); index; ++index)
            numbered.emplace_back(id ? id->get(*index) : 0,
                                  grid->indexToWorld(Vec3d(position.get(*index)) + index.getCoord().asVec3d()));
    }
    std::stable_sort(numbered.begin(), numbered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Vec3d> positions;
    positions.reserve(numbered.size());
    for (const auto& [id, position] : numbered) positions.push_back(position);
    return positions;
}

std::vector<Vec3d> read_points(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) throw InputError(fmt::format("sites {}: no such file", file.string()));
    if (extension == ".csv") return read_csv(file);
    if (extension == ".ply") return read_mesh_vertices(file);
    if (extension == ".vdb") {
        try {
            return read_point_grid(file);
        } catch (const openvdb::Exception& exception) {
            // Attributes of another type than their name promises.
            throw InputError(fmt::format("sites {}: {}", file.string(), exception.what()));
        }
    }
    throw InputError(fmt::format("sites {}: not a kind of file that can be read (.csv, .ply, .vdb)", file.string()));
}

}  // namespace

std::vector<Vec3d> read_site_file(const std::filesystem::path& file, double mm_per_unit) {
    std::vector<Vec3d> points = read_points(file);
    if (points.empty()) throw InputError(fmt::format("sites {}: holds no points", file.string()));
    if (points.size() > max_sites)
        throw InputError(
            fmt::format("sites {}: holds {} points; at most {} are possible", file.string(), points.size(), max_sites));
    for (std::size_t n = 0; n < points.size(); ++n) {
        points[n] *= mm_per_unit;
        if (!(std::max({std::abs(points[n].x()), std::abs(points[n].y()), std::abs(points[n].z())}) <= farthest_mm))
            throw InputError(
                fmt::format("sites {}: point {} lies beyond {:g} mm from the origin", file.string(), n + 1, farthest_mm));
    }
    return points;
}

}  // namespace opal
