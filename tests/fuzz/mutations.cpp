// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutations.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "formats/image.h"
#include "formats/opal_asset_io.h"

namespace opal::fuzz {
namespace {

const std::vector<std::string> odd_values = {"nan",
                                             "inf",
                                             "-inf",
                                             "1e300",
                                             "-1e300",
                                             "1e-300",
                                             "-1",
                                             "0",
                                             "-0.0",
                                             "1e7",
                                             "1e6",
                                             "1e-7",
                                             "1e-4",
                                             "65536",
                                             "1",
                                             "2",
                                             "0.5",
                                             "\"\"",
                                             "\"x\"",
                                             "[]",
                                             "{}",
                                             "[1, 2]",
                                             "true",
                                             "false",
                                             "1979-05-27",
                                             "1_000",
                                             "0x10",
                                             "\"/\"",
                                             "\".\"",
                                             "\"/dev/null\"",
                                             "\"/dev/zero\"",
                                             "[[1]]",
                                             "[\"x\"]",
                                             "\"cells.vdb\"",
                                             "\"cube.obj\"",
                                             "\"n.csv\"",
                                             "\"env.exr\"",
                                             "\"open.obj\"",
                                             "\"m0\"",
                                             "\"\\u0000\"",
                                             "\"\\n\\u001b[31m\"",
                                             "9223372036854775807",
                                             "-9223372036854775808",
                                             "99999999999999999999",
                                             "[nan, 0.0, 0.0]",
                                             "[inf, 0.0, 0.0]",
                                             "[1e7, 1e7, 1e7]",
                                             "[0.0, 0.0, 0.0]",
                                             "[1e300, 0.0, 0.0]",
                                             "[1e-300, 0.0, 1.0]"};

constexpr float odd_floats[] = {std::numeric_limits<float>::quiet_NaN(),
                                std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::max(),
                                -1.0f,
                                -1.0e-3f,
                                1.0e-38f,
                                1.0e10f,
                                0.0f,
                                0.5f,
                                3.0e9f};

float odd_float(CaseRandom& random) {
    return odd_floats[random.below(std::size(odd_floats))];
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    if (lines.empty()) lines.emplace_back();
    return lines;
}

/// Another number in place of one: scaled, of the other sign, or an end of what numbers can be.
std::string odd_number(const std::string& number, CaseRandom& random) {
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    const double odd = random.chance(0.5) ? value * random.pick({-1.0, 0.0, 0.1, 1.001, 3.0, 100.0, 1.0e6})
                                          : random.pick({0.0, 1.0, 0.5, 1.0e-3, 1.0e-5, 90.0, 1.0e4, 9.9e6});
    const bool whole = number.find_first_of(".e") == std::string::npos;
    return whole && std::abs(odd) < 1.0e15 ? fmt::format("{}", std::llround(odd)) : fmt::format("{:#}", odd);
}

/// Puts another value behind a key: an odd one, or one that the key has in another text.
void change_value(std::string& line, const std::vector<std::string>& other, CaseRandom& random) {
    const std::size_t equals = line.find("= ");
    if (equals == std::string::npos) return;
    const std::string key = line.substr(0, equals + 2), value = line.substr(equals + 2);
    const std::size_t start = random.below(other.size());
    const double way = double(uniform_float(random.word()));
    for (std::size_t i = 0; way < 0.25 && i < other.size(); ++i)
        if (const std::string& found = other[(start + i) % other.size()]; found.starts_with(key) && found != line) {
            line = found;
            return;
        }
    const std::size_t digit = value.find_first_of("0123456789", random.below(value.size() + 1));
    if (way < 0.6 && digit != std::string::npos) {
        const std::size_t begin = digit > 0 && value[digit - 1] == '-' ? digit - 1 : digit;
        const std::size_t end = std::min(value.find_first_not_of("0123456789.e+-", digit), value.size());
        line = key + value.substr(0, begin) + odd_number(value.substr(begin, end - begin), random) + value.substr(end);
    } else if (way < 0.9) {
        line = key + random.pick(odd_values);
    } else {
        line = key + random.pick({"-", "1", "0.", "100000", "1e", "[", "\""}) + value;
    }
}

void mutate_lines(std::vector<std::string>& lines, const std::vector<std::string>& other, CaseRandom& random) {
    const std::size_t at = random.below(lines.size()), place = random.below(lines.size());
    switch (random.below(9)) {
        case 0:
            lines.erase(lines.begin() + std::ptrdiff_t(at));
            if (lines.empty()) lines.emplace_back();
            break;
        case 1:
            lines.insert(lines.begin() + std::ptrdiff_t(place), std::string(lines[at]));
            break;
        case 2:
            std::swap(lines[at], lines[place]);
            break;
        case 3: {
            const std::size_t from = random.below(other.size());
            const std::size_t count = std::min<std::size_t>(1 + random.below(12), other.size() - from);
            lines.insert(lines.begin() + std::ptrdiff_t(at), other.begin() + std::ptrdiff_t(from),
                         other.begin() + std::ptrdiff_t(from + count));
            break;
        }
        default:
            for (std::size_t i = 0; i < lines.size(); ++i)
                if (std::string& line = lines[(at + i) % lines.size()]; line.find("= ") != std::string::npos) {
                    change_value(line, other, random);
                    return;
                }
    }
}

}  // namespace

std::string mutated_text(const std::string& text, const std::string& other, CaseRandom& random) {
    if (random.chance(0.15)) return mutated_bytes(text, random);
    std::vector<std::string> lines = lines_of(text);
    const std::vector<std::string> others = lines_of(other);
    const int count = random.pick({1, 1, 1, 2, 3});
    for (int i = 0; i < count; ++i) mutate_lines(lines, others, random);
    std::string mutated;
    for (const std::string& line : lines) mutated += line + '\n';
    return mutated;
}

std::string mutated_bytes(std::string bytes, CaseRandom& random) {
    if (bytes.empty()) return std::string(1, char(random.word()));
    const std::size_t reach =
        random.chance(0.6) ? std::min<std::size_t>(bytes.size(), random.pick({64, 600, 4000})) : bytes.size();
    const std::size_t at = random.below(reach);
    const auto overwrite = [&](const std::string& by) { bytes.replace(at, std::min(by.size(), bytes.size() - at), by); };
    switch (random.below(8)) {
        case 0:
            bytes.resize(random.chance(0.7) ? random.below(bytes.size()) : at);
            break;
        case 1:
            overwrite(std::string(random.pick({1, 4, 64}), '\0'));
            break;
        case 2:
            overwrite(std::string(random.pick({1, 4, 8}), '\xFF'));
            break;
        case 3:
            bytes.insert(at, bytes.substr(at, random.pick({1, 5, 100})));
            break;
        case 4:
            bytes.erase(at, random.pick({1, 4, 100}));
            break;
        case 5:
            overwrite(
                random.pick({std::string("\xFF\xFF\xFF\x7F", 4), std::string("\0\0\0\x80", 4), std::string("\0\0\xC0\x7F", 4),
                             std::string("\0\0\x80\x7F", 4), std::string("\1\0\0\0", 4), std::string("\0\0\x10\0", 4)}));
            break;
        default: {
            const int flips = random.pick({1, 1, 2, 8});
            for (int i = 0; i < flips; ++i) {
                char& byte = bytes[random.below(reach)];
                byte = char(byte ^ (1 << random.below(8)));
            }
        }
    }
    return bytes;
}

namespace {

void drop_words_read_as_floats(Image& image) {
    const std::size_t channels = image.channel_names.size();
    std::vector<std::size_t> kept;
    for (std::size_t c = 0; c < channels; ++c)
        if (std::find(image.word_names.begin(), image.word_names.end(), image.channel_names[c]) == image.word_names.end())
            kept.push_back(c);
    std::vector<std::string> names;
    for (const std::size_t c : kept) names.push_back(image.channel_names[c]);
    std::vector<float> pixels;
    for (std::size_t p = 0; p < image.pixels.size(); p += channels)
        for (const std::size_t c : kept) pixels.push_back(image.pixels[p + c]);
    image.channel_names = names;
    image.pixels = pixels;
}

}  // namespace

void write_mutated_picture(const std::filesystem::path& from, const std::filesystem::path& to, CaseRandom& random) {
    Image image = read_image(from);
    read_words(from, image);
    drop_words_read_as_floats(image);
    const int count = random.pick({1, 1, 2});
    for (int i = 0; i < count; ++i) switch (random.below(7)) {
            case 0:
            case 1:
                if (!image.pixels.empty()) image.pixels[random.below(image.pixels.size())] = odd_float(random);
                break;
            case 2: {
                const std::size_t channels = image.channel_names.size(), channel = random.below(channels);
                for (std::size_t p = channel; p < image.pixels.size(); p += channels) image.pixels[p] = odd_float(random);
                break;
            }
            case 3:
                if (!image.words.empty())
                    image.words[random.below(image.words.size())] = random.pick({0u, 0xFFFFFFFFu, 0x7FF80000u});
                break;
            case 4: {
                if (image.attributes.empty()) break;
                auto attribute = image.attributes.begin();
                std::advance(attribute, std::ptrdiff_t(random.below(image.attributes.size())));
                attribute->second =
                    random.chance(0.2) ? std::string() : mutated_text(attribute->second, attribute->second, random);
                break;
            }
            case 5:
                image.channel_names[random.below(image.channel_names.size())] =
                    random.pick({"x", "R", "S0.360nm", "exact.sum.R.low"});
                break;
            default:
                image.x0 = random.pick({-5, 0, 3, 1 << 20});
                image.full_width = random.pick({0, 1, 12, 1 << 24});
                image.full_height = random.pick({0, 1, 9, 1 << 24});
        }
    write_exr(to, image);
}

namespace {

void mutate_metadata(openvdb::MetaMap& metadata, CaseRandom& random) {
    std::vector<std::string> names;
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) names.push_back(entry->first);
    if (names.empty()) return;
    const std::string& name = random.pick(names);
    const openvdb::Metadata::Ptr old = metadata[name];
    if (random.chance(0.1)) {
        metadata.removeMeta(name);
    } else if (old->typeName() == "string") {
        const std::string value = old->str();
        metadata.removeMeta(name);
        metadata.insertMeta(name,
                            openvdb::StringMetadata(random.chance(0.2) ? std::string() : mutated_text(value, value, random)));
    } else if (old->typeName() == "float") {
        metadata.insertMeta(name, openvdb::FloatMetadata(odd_float(random)));
    } else if (old->typeName() == "double") {
        metadata.insertMeta(name, openvdb::DoubleMetadata(double(odd_float(random))));
    } else if (old->typeName() == "int64") {
        metadata.insertMeta(
            name, openvdb::Int64Metadata(random.pick({std::int64_t(-1), std::int64_t(0), INT64_MAX, std::int64_t(1) << 40})));
    } else if (old->typeName() == "int32") {
        metadata.insertMeta(name, openvdb::Int32Metadata(random.pick({-1, 0, 1 << 30})));
    }
}

template <typename Grid, typename Odd>
void mutate_values(Grid& grid, CaseRandom& random, const Odd& odd) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) return;
    const bool far = random.chance(0.1);
    const auto dim = box.dim();
    const int count = random.pick({1, 1, 10, 1000});
    for (int i = 0; i < count; ++i) {
        openvdb::Coord place = box.min();
        for (int axis = 0; axis < 3; ++axis) place[axis] += int(random.below(std::size_t(dim[axis])));
        if (far) place[0] += random.pick({1 << 12, 1 << 20});
        const typename Grid::ValueType value = odd();
        if (random.chance(0.2))
            grid.tree().addTile(1, place, value, true);
        else
            grid.tree().setValue(place, value);
        if (far) return;
    }
}

void mutate_grid(openvdb::GridBase& grid, CaseRandom& random) {
    switch (random.below(5)) {
        case 0:
            grid.setName(random.pick({"", "shape", "grain_id", "sites", "sigma_a_scale", "x"}));
            return;
        case 1: {
            openvdb::Mat4d matrix = openvdb::Mat4d::identity();
            matrix[int(random.below(3))][int(random.below(3))] = random.pick({0.3, 1.0e-4, 1.0e4, 2.0, -1.0, 1.0e12});
            matrix[3][int(random.below(3))] = random.pick({0.0, 5.0, 1.0e7});
            try {
                grid.setTransform(openvdb::math::Transform::createLinearTransform(matrix));
            } catch (const openvdb::Exception&) {  // singular
            }
            return;
        }
        case 2:
            grid.setGridClass(random.pick({openvdb::GRID_LEVEL_SET, openvdb::GRID_FOG_VOLUME, openvdb::GRID_UNKNOWN}));
            return;
        default:
            break;
    }
    if (auto* const floats = dynamic_cast<openvdb::FloatGrid*>(&grid))
        mutate_values(*floats, random, [&] { return odd_float(random); });
    else if (auto* const ids = dynamic_cast<openvdb::Int32Grid*>(&grid))
        mutate_values(*ids, random, [&] { return random.pick({-1, 0, 1, 1000, 1 << 24, 0x7FFFFFFF}); });
    else
        mutate_metadata(grid, random);
}

}  // namespace

void write_mutated_grids(const std::filesystem::path& from, const std::filesystem::path& to, CaseRandom& random) {
    RawOpalFile raw = read_raw_opal_file(from);
    const int count = random.pick({1, 1, 2});
    for (int i = 0; i < count; ++i) {
        if (raw.grids.empty() || random.chance(0.4))
            mutate_metadata(raw.metadata, random);
        else if (random.chance(0.05))
            raw.grids.erase(raw.grids.begin() + std::ptrdiff_t(random.below(raw.grids.size())));
        else
            mutate_grid(*random.pick(raw.grids), random);
    }
    openvdb::io::File file(to.string());
    file.write(raw.grids, raw.metadata);
    file.close();
}

}  // namespace opal::fuzz
