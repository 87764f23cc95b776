// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/coat_albedo.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/fresnel.h"
#include "renderer/core/microfacet.h"

namespace opal {
namespace {

double albedo_at(const Ggx& ggx, float eta, float cosine) {
    constexpr int strata = 48;
    const Vec3 out{std::sqrt(1.0f - cosine * cosine), 0.0f, cosine};
    double sum = 0.0;
    for (int i = 0; i < strata; ++i)
        for (int j = 0; j < strata; ++j) {
            const Vec3 half = ggx.sample_visible(out, (float(i) + 0.5f) / strata, (float(j) + 0.5f) / strata);
            const Vec3 in = 2.0f * dot(out, half) * half - out;
            real unused;
            if (in.z > 0.0f)
                sum += double(ggx.shadowing(out, in) * fresnel_dielectric(std::fmin(1.0f, dot(out, half)), eta, unused));
        }
    return sum / (strata * strata);
}

/// Cosine-weighted mean of a function that is linear in r = sqrt(cos) between the samples: integral of E 4 r^3 dr.
float mean_of(const std::vector<float>& values) {
    double mean = 0.0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        const double a = double(i) / (coat_albedo_samples - 1), b = double(i + 1) / (coat_albedo_samples - 1);
        const double low = double(values[i]), high = double(values[i + 1]);
        const double fourth = std::pow(b, 4) - std::pow(a, 4), fifth = 0.8 * (std::pow(b, 5) - std::pow(a, 5));
        mean += low * fourth + (high - low) / (b - a) * (fifth - a * fourth);
    }
    return float(mean);
}

}  // namespace

CoatAlbedo make_coat_albedo(float roughness, std::span<const EtaRange> ranges) {
    // Between two entries of one medium, interpolation is off by less than the sums.
    constexpr float widest_step = 0.01f;
    const Ggx ggx{roughness};
    CoatAlbedo table;
    for (const EtaRange& range : ranges) {
        const int steps = int(std::ceil((range.most - range.least) / widest_step));
        for (int i = 0; i <= steps; ++i)
            table.eta.push_back(steps == 0 ? range.least : range.least + (range.most - range.least) * float(i) / float(steps));
    }
    std::sort(table.eta.begin(), table.eta.end());
    table.eta.erase(std::unique(table.eta.begin(), table.eta.end()), table.eta.end());
    for (const float eta : table.eta) {
        std::vector<float> values;
        for (int i = 0; i < coat_albedo_samples; ++i) {
            const float root = float(i) / (coat_albedo_samples - 1);
            values.push_back(float(albedo_at(ggx, eta, std::fmax(1.0e-4f, root * root))));
        }
        table.value.insert(table.value.end(), values.begin(), values.end());
        table.mean.push_back(mean_of(values));
    }
    return table;
}

}  // namespace opal
