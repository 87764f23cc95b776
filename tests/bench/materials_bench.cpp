// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <string>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/metals.h"
#include "renderer/core/conductor.h"
#include "renderer/core/path_random.h"
#include "renderer/core/rough_interface.h"

namespace opal {
namespace {

constexpr float glass_index = 1.45f;
constexpr int draws = 100'000;

void write_text(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    std::ofstream stream(file.temporary_path());
    stream << text;
    stream.close();
    if (!stream) throw SystemError(fmt::format("{}: writing failed", path.string()));
    file.commit();
}

std::string metals_table() {
    std::string text = "wavelength_nm";
    for (const std::string& name : metal_names()) text += "," + name;
    text += "\n";
    for (int wavelength_nm = 360; wavelength_nm <= 830; wavelength_nm += 5) {
        text += fmt::format("{}", wavelength_nm);
        for (const std::string& name : metal_names())
            text += fmt::format(",{:.5f}", normal_reflectance(MetalIndex::of_metal(name).at(wavelength_nm)));
        text += "\n";
    }
    return text;
}

/// Turns light once, and leaves it at that.
template <class Lobe>
double single_share(const Lobe& lobe, float cosine) {
    const Vec3 out{std::sqrt(1.0f - cosine * cosine), 0.0f, cosine};
    int single = 0;
    for (int i = 0; i < draws; ++i) {
        PathRandom random(1, 0, std::uint32_t(i), PathSampler::independent);
        single += lobe.sample(out, random).pdf > 0.0f ? 1 : 0;
    }
    return double(single) / draws;
}

std::string rough_table() {
    std::string text = "roughness,cosine,metal,glass_from_outside,glass_from_inside\n";
    for (int i = 1; i <= 20; ++i)
        for (const float cosine : {1.0f, 0.3f}) {
            const float roughness = 0.05f * float(i);
            Conductor<1> metal;
            metal.roughness = roughness;
            metal.n[0] = 1.0e-3f;
            metal.k[0] = 1.0e6f;
            text += fmt::format("{:.2f},{:.1f},{:.5f},{:.5f},{:.5f}\n", roughness, cosine, single_share(metal, cosine),
                                single_share(RoughInterface<1>{roughness, {glass_index}}, cosine),
                                single_share(RoughInterface<1>{roughness, {1.0f / glass_index}}, cosine));
        }
    return text;
}

}  // namespace

void bench_materials(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write_text(folder / "metals.csv", metals_table());
    write_text(folder / "rough_surfaces.csv", rough_table());
}

}  // namespace opal
