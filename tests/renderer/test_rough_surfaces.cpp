// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <complex>

#include "chi_square.h"
#include "formats/units.h"
#include "renderer/core/conductor.h"
#include "renderer/core/plastic.h"
#include "renderer/core/rough_interface.h"
#include "renderer/host/coat_albedo.h"

/// Metals, rough glass and plastic: samplers against densities, energy, reciprocity, limits.
namespace opal {
namespace {

constexpr float glass = 1.45f;

Vec3 direction_at(double cosine, double azimuth_rad = 0.0) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return {float(sine * std::cos(azimuth_rad)), float(sine * std::sin(azimuth_rad)), float(cosine)};
}

SamplerPoint<2> point_of(Vec3 v) {
    return {double(v.z), std::atan2(double(v.y), double(v.x))};
}

/// Over the cosine and the azimuth, in which equal cells are equal solid angles.
SamplerDomain<2> sphere_domain(double lowest) {
    return {{lowest, -units::pi}, {1.0, units::pi}, {32, 32}};
}

/// Integral over the sphere from `lowest` up: midpoints in the polar angle and the azimuth.
template <typename Function>
double sphere_integral(const Function& function, double lowest = -1.0) {
    constexpr int rows = 1200, columns = 600;
    const double farthest_rad = std::acos(lowest);
    double sum = 0.0;
    for (int i = 0; i < rows; ++i) {
        const double angle_rad = (i + 0.5) * farthest_rad / rows;
        for (int j = 0; j < columns; ++j)
            sum +=
                std::sin(angle_rad) * double(function(direction_at(std::cos(angle_rad), (2.0 * j + 1.0) * units::pi / columns)));
    }
    return sum * farthest_rad / rows * 2.0 * units::pi / columns;
}

template <int N>
Conductor<N> metal(float roughness, float n, float k) {
    Conductor<N> result;
    result.roughness = roughness;
    for (int i = 0; i < N; ++i) {
        result.n[i] = n;
        result.k[i] = k;
    }
    return result;
}

Plastic<1> plastic(float roughness, float albedo, CoatAlbedo& coat, float eta = 1.5f) {
    Plastic<1> result;
    result.roughness = roughness;
    result.eta[0] = eta;
    result.albedo[0] = albedo;
    if (!result.smooth()) {
        coat = make_coat_albedo(roughness, std::vector<EtaRange>{{eta, eta}});
        result.coat_albedo = coat.view();
    }
    return result;
}

/// Of `draws` samples: the mean weight of the first lane, its standard error, the shares of single turns and of transmissions.
struct Tally {
    double mean = 0.0, error = 0.0, single = 0.0, transmitted = 0.0;
};

template <class Lobe>
Tally tally(const Lobe& lobe, Vec3 out, int draws) {
    Tally result;
    double squares = 0.0;
    for (int i = 0; i < draws; ++i) {
        SamplerRandom random{std::uint64_t(i)};
        const auto sample = lobe.sample(out, random);
        const double weight = dot(sample.direction, sample.direction) > 0.5f ? double(sample.weight.v[0]) : 0.0;
        result.mean += weight / draws;
        squares += weight * weight / draws;
        result.single += sample.pdf > 0.0f ? 1.0 / draws : 0.0;
        result.transmitted += sample.transmitted ? 1.0 / draws : 0.0;
    }
    result.error = std::sqrt(std::max(0.0, squares - result.mean * result.mean) / draws);
    return result;
}

/// The single turns of a lobe against its density, and how many there are.
template <class Lobe>
void check_lobe(const std::string& name, const Lobe& lobe, Vec3 out, double lowest) {
    const double expected = sphere_integral([&](Vec3 in) { return lobe.evaluate(out, in).pdf; }, lowest);
    EXPECT_TRUE(check_sampler(
        name, sphere_domain(lowest),
        [&](SamplerRandom& random) {
            while (true) {
                const auto sample = lobe.sample(out, random);
                if (sample.pdf > 0.0f) return point_of(sample.direction);
            }
        },
        [&](SamplerPoint<2> p) { return double(lobe.evaluate(out, direction_at(p[0], p[1])).pdf) / expected; }, 300'000));
    constexpr int draws = 100'000;
    EXPECT_NEAR(tally(lobe, out, draws).single, expected, 4.0 * std::sqrt(0.25 / draws) + 1.0e-4) << name;
}

TEST(Microfacets, NormalsCoverTheSurfaceOnce) {
    for (const float alpha : {0.1f, 0.5f, 1.0f})
        EXPECT_NEAR(sphere_integral([&](Vec3 h) { return h.z * Ggx{alpha}.density(h); }, 0.0), 1.0, 1.0e-3) << alpha;
}

TEST(Microfacets, VisibleNormals) {
    for (const float alpha : {0.3f, 0.9f})
        for (const double cosine : {0.9, 0.2, -0.4}) {
            const Ggx ggx{alpha};
            const Vec3 out = direction_at(cosine, 0.7);
            EXPECT_TRUE(check_sampler(
                fmt::format("visible normals {} {}", alpha, cosine), sphere_domain(0.0),
                [&](SamplerRandom& random) {
                    const float u1 = random.next();
                    return point_of(ggx.sample_visible(out, u1, random.next()));
                },
                [&](SamplerPoint<2> p) { return double(ggx.visible_density(out, direction_at(p[0], p[1]))); }, 300'000));
        }
}

TEST(Conductor, FresnelLimits) {
    for (const float cosine : {1.0f, 0.8f, 0.4f, 0.1f, 0.01f}) {
        float unused;
        EXPECT_NEAR(fresnel_conductor(cosine, glass, 0.0f), fresnel_dielectric(cosine, glass, unused), 1.0e-5f) << cosine;
        EXPECT_NEAR(fresnel_conductor(cosine, 0.01f, 1.0e4f), 1.0f, 1.0e-4f) << cosine;
    }
    EXPECT_NEAR(fresnel_conductor(1.0f, 0.43f, 2.455f), (0.57 * 0.57 + 2.455 * 2.455) / (1.43 * 1.43 + 2.455 * 2.455), 1.0e-6);
    EXPECT_NEAR(fresnel_conductor(0.0f, 0.43f, 2.455f), 1.0f, 1.0e-6f);
    // At 45 degrees the reflectance of p-polarized light is the square of that of s (Abeles): F = (s + s^2) / 2.
    const std::complex<double> index(0.43, 2.455);
    const std::complex<double> beyond = std::sqrt(index * index - 0.5);
    const double s = std::norm((std::sqrt(0.5) - beyond) / (std::sqrt(0.5) + beyond));
    EXPECT_NEAR(double(fresnel_conductor(std::sqrt(0.5f), 0.43f, 2.455f)), 0.5 * (s + s * s), 1.0e-6);
}

TEST(Conductor, SamplerMatchesDensity) {
    for (const float roughness : {0.2f, 0.7f})
        for (const double cosine : {0.95, 0.3})
            check_lobe(fmt::format("conductor {} {}", roughness, cosine), metal<1>(roughness, 0.2f, 3.5f), direction_at(cosine),
                       0.0);
}

/// A perfect metal returns all light however rough it is; a real one at most that.
TEST(Conductor, LosesNothingButWhatItAbsorbs) {
    for (const float roughness : {0.0f, 0.001f, 0.1f, 0.4f, 1.0f})
        for (const double cosine : {1.0, 0.5, 0.05}) {
            EXPECT_NEAR(tally(metal<1>(roughness, 1.0e-3f, 1.0e6f), direction_at(cosine), 1000).mean, 1.0, 1.0e-4)
                << roughness << " " << cosine;
            const Tally gold = tally(metal<1>(roughness, 0.43f, 2.455f), direction_at(cosine), 10'000);
            EXPECT_LE(gold.mean, 1.0);
            EXPECT_GT(gold.mean, 0.6);
        }
}

TEST(Conductor, BecomesAMirrorAsRoughnessVanishes) {
    for (const double cosine : {1.0, 0.5, 0.2}) {
        const double expected = double(fresnel_conductor(float(cosine), 0.43f, 2.455f));
        EXPECT_NEAR(tally(metal<1>(0.0f, 0.43f, 2.455f), direction_at(cosine), 1).mean, expected, 1.0e-6);
        EXPECT_NEAR(tally(metal<1>(0.002f, 0.43f, 2.455f), direction_at(cosine), 10'000).mean, expected, 1.0e-3);
    }
}

TEST(Conductor, Reciprocal) {
    const Conductor<1> gold = metal<1>(0.5f, 0.43f, 2.455f);
    const Vec3 a = direction_at(0.8, 0.3), b = direction_at(0.25, 2.0);
    EXPECT_NEAR(gold.evaluate(a, b).f_cosine.v[0] / b.z, gold.evaluate(b, a).f_cosine.v[0] / a.z, 1.0e-5f);
}

TEST(RoughInterface, SamplerMatchesDensity) {
    for (const float roughness : {0.25f, 0.8f})
        for (const float eta : {glass, 1.0f / glass})
            for (const double cosine : {0.95, 0.4})
                check_lobe(fmt::format("interface {} {} {}", roughness, eta, cosine), RoughInterface<1>{roughness, {eta}},
                           direction_at(cosine), -1.0);
}

/// Thermal equilibrium: as much diffuse light passes one way as the other, radiance being larger by eta^2 inside. Tests the
/// walks between the small mirrors with the heights on both sides.
TEST(RoughInterface, PassesAsMuchBothWays) {
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        double passed[2] = {};
        constexpr int draws = 400'000;
        for (const bool inside : {false, true}) {
            const RoughInterface<1> surface{roughness, {inside ? 1.0f / glass : glass}};
            for (int i = 0; i < draws; ++i) {
                SamplerRandom random{std::uint64_t(i)};
                const Vec3 out = direction_at(std::sqrt((i + 0.5) / draws));  // cosine-weighted, stratified
                if (surface.sample(out, random).transmitted) passed[inside] += 1.0 / draws;
            }
        }
        const double into = passed[0], out_of = passed[1] * double(glass) * double(glass);
        EXPECT_NEAR(into, out_of, 4.0 * 0.5 / std::sqrt(double(draws)) * (1.0 + double(glass) * double(glass))) << roughness;
    }
}

TEST(RoughInterface, Reciprocal) {
    const RoughInterface<1> outer{0.4f, {glass}}, inner{0.4f, {1.0f / glass}};
    const Vec3 a = direction_at(0.8, 0.3), b = direction_at(0.6, 2.9);
    const Vec3 below = {b.x, b.y, -b.z};
    EXPECT_NEAR(outer.evaluate(a, b).f_cosine.v[0] / b.z, outer.evaluate(b, a).f_cosine.v[0] / a.z, 1.0e-5f);
    // For radiance over the squared index; seen from inside, up is down.
    const float in_to_out = inner.evaluate({below.x, below.y, b.z}, {a.x, a.y, -a.z}).f_cosine.v[0] / a.z;
    const float out_to_in = outer.evaluate(a, below).f_cosine.v[0] / b.z;
    EXPECT_GT(out_to_in, 0.01f);
    EXPECT_NEAR(out_to_in, glass * glass * in_to_out, 1.0e-4f * out_to_in);
}

TEST(RoughInterface, BecomesSmoothAsRoughnessVanishes) {
    for (const float eta : {glass, 1.0f / glass})
        for (const double cosine : {1.0, 0.9, 0.5}) {
            float unused;
            const double expected = 1.0 - double(fresnel_dielectric(float(cosine), eta, unused));
            constexpr int draws = 100'000;
            EXPECT_NEAR(tally(RoughInterface<1>{0.001f, {eta}}, direction_at(cosine), draws).transmitted, expected,
                        4.0 * std::sqrt(0.25 / draws) + 1.0e-3);
        }
}

/// Lanes of other indices: the ratio is that of the densities, single turns and walks alike.
TEST(RoughInterface, LanesShareADirection) {
    const RoughInterface<2> lanes{0.2f, {1.45f, 1.47f}};
    const RoughInterface<1> second{0.2f, {1.47f}};
    const Vec3 out = direction_at(0.7);
    double mean = 0.0, squares = 0.0;
    constexpr int draws = 200'000;
    for (int i = 0; i < draws; ++i) {
        SamplerRandom random{std::uint64_t(i)};
        const BsdfSample<2> sample = lanes.sample(out, random);
        const double ratio = double(sample.ratio.v[1]);
        mean += ratio / draws;
        squares += ratio * ratio / draws;
        if (i < 1000 && sample.pdf > 0.0f) {
            EXPECT_NEAR(ratio, double(second.evaluate(out, sample.direction).pdf / sample.pdf), 1.0e-3 * (1.0 + ratio));
        }
    }
    EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt((squares - mean * mean) / draws));
    EXPECT_GT(squares - mean * mean, 1.0e-4);
}

TEST(Plastic, MeanFresnel) {
    for (const float eta : {1.05f, 1.45f, 2.4f, 1.0f / 1.45f}) {
        double sum = 0.0;
        constexpr int steps = 200'000;
        for (int i = 0; i < steps; ++i) {
            float unused;
            sum += double(fresnel_dielectric(float(std::sqrt((i + 0.5) / steps)), eta, unused)) / steps;
        }
        EXPECT_NEAR(double(mean_fresnel(eta)), sum, 1.0e-4) << eta;
    }
}

TEST(Plastic, SamplerMatchesDensity) {
    CoatAlbedo coat;
    for (const double cosine : {0.95, 0.3}) {
        const Plastic<1> rough = plastic(0.3f, 0.5f, coat);
        const Vec3 out = direction_at(cosine);
        // A lobe that points down is drawn and lost: the density integrates to less than 1.
        check_lobe(fmt::format("plastic {}", cosine), rough, out, 0.0);
    }
}

TEST(Plastic, KeepsEnergy) {
    CoatAlbedo coat;
    for (const double cosine : {1.0, 0.6, 0.2}) {
        const Vec3 out = direction_at(cosine);
        float unused;
        const double f = double(fresnel_dielectric(float(cosine), 1.5f, unused)), below = double(mean_fresnel(1.0f / 1.5f));
        for (const double albedo : {1.0, 0.6, 0.0}) {
            const Tally smooth = tally(plastic(0.0f, float(albedo), coat), out, 200'000);
            EXPECT_NEAR(smooth.mean, f + (1.0 - f) * albedo * (1.0 - below) / (1.0 - albedo * below),
                        4.0 * smooth.error + 1.0e-4);
        }
        for (const float roughness : {0.1f, 0.4f, 1.0f}) {
            const Tally white = tally(plastic(roughness, 1.0f, coat), out, 200'000);
            EXPECT_NEAR(white.mean, 1.0, 4.0 * white.error + 2.0e-3) << roughness << " " << cosine;
        }
    }
}

/// Against what is before it in an opal or in glass; total reflection begins at 0.436 of the cosine where the coat's index is 0.9
/// of that. A coat met between two entries of its table (dispersion) as well.
TEST(Plastic, AWhiteBaseReturnsAllLightInsideBodies) {
    for (const float eta : {0.9f, 0.99f, 1.0f, 1.02f, 1.1f})
        for (const float roughness : {0.05f, 0.3f, 1.0f})
            for (const double cosine : {1.0, 0.6, 0.47, 0.436, 0.4, 0.2, 0.05}) {
                CoatAlbedo coat;
                const Tally white = tally(plastic(roughness, 1.0f, coat, eta), direction_at(cosine), 100'000);
                EXPECT_NEAR(white.mean, 1.0, 4.0 * white.error + 5.0e-3) << eta << " " << roughness << " " << cosine;
            }
    const CoatAlbedo coat = make_coat_albedo(0.3f, std::vector<EtaRange>{{1.5f, 1.53f}, {1.03f, 1.06f}});
    EXPECT_EQ(coat.eta.size(), 8u);
    for (const float eta : {1.034f, 1.0555f, 1.515f}) {
        Plastic<1> between{0.3f, {eta}, {1.0f}, coat.view()};
        for (const double cosine : {0.9, 0.3, 0.05}) {
            const Tally white = tally(between, direction_at(cosine), 200'000);
            EXPECT_NEAR(white.mean, 1.0, 4.0 * white.error + 5.0e-3) << eta << " " << cosine;
        }
    }
}

TEST(Plastic, Reciprocal) {
    CoatAlbedo coat;
    for (const float roughness : {0.0f, 0.4f}) {
        const Plastic<1> surface = plastic(roughness, 0.7f, coat);
        const Vec3 a = direction_at(0.8, 0.3), b = direction_at(0.25, 2.0);
        EXPECT_NEAR(surface.evaluate(a, b).f_cosine.v[0] / b.z, surface.evaluate(b, a).f_cosine.v[0] / a.z, 1.0e-5f);
    }
}

}  // namespace
}  // namespace opal
