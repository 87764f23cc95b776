// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/environment_map.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/error.h"
#include "formats/image.h"
#include "formats/units.h"
#include "renderer/host/upsampler.h"

namespace opal {
namespace {

/// The picture as it was given, linear sRGB.
struct Picture {
    int width = 0, height = 0;
    std::vector<Rgb> texels;
};

Picture picture_of(Rgb (*radiance)(Vec3 direction)) {
    Picture map{1024, 512, std::vector<Rgb>(std::size_t(1024) * 512)};
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const double theta = units::pi * (y + 0.5) / map.height, phi = 2.0 * units::pi * (x + 0.5) / map.width;
            const Vec3 direction{float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
                                 float(std::cos(theta))};
            map.texels[std::size_t(y) * map.width + x] = radiance(direction);
        }
    return map;
}

Picture constant_picture() {
    return {64, 32, std::vector<Rgb>(std::size_t(64) * 32, Rgb{1.0f, 1.0f, 1.0f})};
}

/// Negative radiance counts as none, as long as it is little: filters with negative lobes and changes of the colour space leave
/// some in pictures that are otherwise sound.
class NegativeTexels {
  public:
    explicit NegativeTexels(std::string file) : file_(std::move(file)) {}

    /// A component as it counts. Throws InputError where it is no finite number.
    float checked(float component, int x, int y) {
        if (!std::isfinite(component))
            throw InputError(fmt::format("{}: texel ({}, {}) is {}; radiance must be finite", file_, x, y, component));
        if (component >= 0.0f) {
            light_ += double(component);
            return component;
        }
        cut_off_ -= double(component);
        ++count_;
        if (component < lowest_) {
            lowest_ = component;
            place_ = fmt::format("({}, {})", x, y);
        }
        return 0.0f;
    }

    void finish(std::vector<std::string>* notices) const {
        if (count_ == 0) return;
        const std::string what =
            fmt::format("{}: {} values of texels are negative, the lowest, {}, at texel {}", file_, count_, lowest_, place_);
        if (!(cut_off_ <= allowed_share * light_))
            throw InputError(
                fmt::format("{}; together {:.3g} of the picture's light, allowed: {:g}", what, cut_off_ / light_, allowed_share));
        if (notices) notices->push_back(what + "; they count as 0");
    }

  private:
    static constexpr double allowed_share = 0.01;
    std::string file_, place_;
    double light_ = 0.0, cut_off_ = 0.0;
    float lowest_ = 0.0f;
    std::size_t count_ = 0;
};

Picture picture_from_file(const std::filesystem::path& path, std::vector<std::string>* notices) {
    NegativeTexels negatives(path.string());
    const Image image = read_image(path);
    if (image.num_channels() < 3 && image.num_channels() != 1)
        throw InputError(fmt::format("{}: {} channels; an environment has 1 or 3", path.string(), image.num_channels()));
    Picture map{image.width, image.height, {}};
    map.texels.reserve(std::size_t(map.width) * map.height);
    const int green = image.num_channels() >= 3 ? 1 : 0, blue = image.num_channels() >= 3 ? 2 : 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            // Longitude runs clockwise in pictures of this kind and counter-clockwise here; the middle column looks along +Y.
            const int column = ((map.width - 1 - x) + 3 * map.width / 4) % map.width;
            const float* pixel = image.pixel(column, y);
            Rgb value{pixel[0], pixel[green], pixel[blue]};
            for (real* const component : {&value.r, &value.g, &value.b})
                *component = negatives.checked(float(*component), column, y);
            map.texels.push_back(value);
        }
    negatives.finish(notices);
    return map;
}

Picture picture_of(const EnvironmentDescription& description, std::vector<std::string>* notices) {
    switch (description.kind) {
        case EnvironmentKind::constant:
            return constant_picture();
        case EnvironmentKind::file:
            return picture_from_file(description.file, notices);
        case EnvironmentKind::tent:
            return picture_of(tent_radiance);
        case EnvironmentKind::studio:
            break;
    }
    return picture_of(studio_radiance);
}

/// Weight of each texel for drawing directions: the mean of its 3x3 neighbourhood, since bilinear lookup spreads it, times its
/// solid angle.
void build_tables(const Picture& picture, EnvironmentMap& map) {
    const auto luminance = [&](int x, int y) {
        const int column = (x + map.width) % map.width, row = std::min(std::max(y, 0), map.height - 1);
        const Rgb& texel = picture.texels[std::size_t(row) * map.width + column];
        return 0.2126 * double(texel.r) + 0.7152 * double(texel.g) + 0.0722 * double(texel.b);
    };
    std::vector<double> row_weight(map.height);
    double total = 0.0;
    for (int y = 0; y < map.height; ++y) {
        std::vector<double> sums(std::size_t(map.width) + 1, 0.0);
        for (int x = 0; x < map.width; ++x) {
            double neighbourhood = 0.0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) neighbourhood += luminance(x + i, y + j);
            sums[std::size_t(x) + 1] = sums[x] + neighbourhood;
        }
        const double row_sum = sums.back();
        for (int x = 0; x <= map.width; ++x)
            map.column_cdf.push_back(float(row_sum > 0.0 ? sums[x] / row_sum : double(x) / map.width));
        row_weight[y] = row_sum * std::sin(units::pi * (y + 0.5) / map.height);
        total += row_weight[y];
    }
    double sum = 0.0;
    map.row_cdf.push_back(0.0f);
    for (int y = 0; y < map.height; ++y) {
        sum += row_weight[y];
        map.row_cdf.push_back(float(total > 0.0 ? sum / total : double(y + 1) / map.height));
    }
}

/// Sums of more would leave the range of single precision.
constexpr double largest_radiance = 1.0e30;

double mean_luminance(const Picture& picture) {
    double sum = 0.0, solid_angle = 0.0;
    for (int y = 0; y < picture.height; ++y) {
        const double sine = std::sin(units::pi * (y + 0.5) / picture.height);
        for (int x = 0; x < picture.width; ++x) {
            const Rgb& texel = picture.texels[std::size_t(y) * picture.width + x];
            sum += sine * (0.2126 * double(texel.r) + 0.7152 * double(texel.g) + 0.0722 * double(texel.b));
            solid_angle += sine;
        }
    }
    return sum / solid_angle;
}

}  // namespace

EnvironmentMap make_environment(const EnvironmentDescription& description, Upsampling upsampling,
                                std::vector<std::string>* notices) {
    const Picture picture = picture_of(description, notices);
    EnvironmentMap map;
    map.width = picture.width;
    map.height = picture.height;
    map.rotation_rad = units::rad_from_deg(description.rotate_deg);
    build_tables(picture, map);
    map.mean_luminance = float(description.radiance * mean_luminance(picture));
    map.texels.reserve(picture.texels.size());
    const UpsamplingMethod method = upsampling_method(upsampling);
    for (const Rgb& texel : picture.texels) {
        const double largest = description.radiance * double(std::max({texel.r, texel.g, texel.b}));
        if (!(largest <= largest_radiance))
            throw InputError(fmt::format("{}: radiance {:.3g}, times environment.radiance; allowed: up to {:g}",
                                         description.file.string(), largest, largest_radiance));
        map.texels.push_back(upsample_radiance(method, texel));
        map.texels.back().scale *= float(description.radiance);
    }
    return map;
}

}  // namespace opal
