// SPDX-License-Identifier: GPL-3.0-or-later
#include "recipe_text.h"

#include <fmt/format.h>

namespace opal::fuzz {
namespace {

class RecipeWriter {
  public:
    explicit RecipeWriter(CaseRandom& random) : random_(random) {}

    std::string recipe() {
        add_shape();
        add_grains();
        add_crystal();
        add_base_color();
        if (random_.chance(0.3))
            line("[output]\ngrids = {}", random_.pick({"[\"sites\"]", "[\"shape\", \"sites\"]", "[\"grain_id\"]",
                                                       "[\"grain_id\", \"shape\", \"weight\", \"fields\", \"sites\"]"}));
        return std::move(text_);
    }

  private:
    template <typename... Values>
    void line(fmt::format_string<Values...> format, Values&&... values) {
        text_ += fmt::format(format, std::forward<Values>(values)...) + '\n';
    }
    double size() { return random_.pick({0.001, 0.5, 3.0, 5.0, 6.0, 400.0}); }

    void add_shape() {
        const std::string kind = random_.pick({"ellipsoid", "sphere", "box", "cabochon", "cabochon", "mesh", "bezier"});
        line("[shape]\nkind = \"{}\"", kind);
        if (kind == "mesh") {
            line("file = \"{}\"", random_.pick({"cube.obj", "cube.ply", "cube.stl"}));
            if (random_.chance(0.3)) line("scale = {}", random_.pick({0.001, 0.5, 100.0}));
        } else if (kind == "bezier" && random_.chance(0.15)) {
            line("patches = \"teapot\"\nlongest_mm = 6.0");
        } else if (kind == "sphere") {
            line("size_mm = {}", size());
        } else {
            const double y = size();
            const double x = y * random_.pick({1.0, 1.3, 2.0});
            line("size_mm = [{}, {}, {}]", x, y, y * random_.pick({0.05, 0.5, 0.8}));
        }
    }

    std::string weight_term() {
        const std::string kind = random_.pick({"none", "perlin", "simplex", "linear", "radial", "distance", "grid", "csv"});
        if (kind == "grid") return "{ kind = \"grid\", file = \"fields.vdb\", grid = \"sigma_a_scale\" }";
        if (kind == "csv") return "{ kind = \"csv\", file = \"weights.csv\" }";
        if (kind == "none") return "{ kind = \"none\" }";
        const double amplitude = random_.pick({-3.0, 0.1, 0.5, 50.0});
        const double scale_mm = random_.pick({0.01, 1.0, 3.0, 1000.0});
        return fmt::format("{{ kind = \"{}\", amplitude = {}, scale_mm = {}, octaves = {} }}", kind, amplitude, scale_mm,
                           random_.integer(1, 6));
    }

    void add_grains() {
        line("[grains]\nseed = {}", random_.word());
        line("resolution = {}", random_.pick({4, 12, 20, 32}));
        const std::string sites = random_.pick({"poisson-disk", "poisson-disk", "jittered-lattice", "file"});
        std::string more =
            sites == "file" ? ", file = \"sites.csv\"" : fmt::format(", region = \"{}\"", random_.pick({"shape", "bounds"}));
        if (sites == "jittered-lattice") more += fmt::format(", jitter = {}", random_.pick({0.0, 0.3, 1.0}));
        line("sites = {{ kind = \"{}\"{} }}", sites, more);
        if (sites != "file") line("num_sites = {}", random_.pick({1, 2, 5, 27, 40, 80}));
        line("tessellation = \"{}\"", random_.pick({"additive", "additive", "voronoi", "multiplicative", "manhattan"}));
        const std::string term = weight_term();
        line("weight = {}", random_.chance(0.2) ? fmt::format("[{}, {}]", term, weight_term()) : term);
        line("limit_weights = {}", random_.chance(0.7));
        if (random_.chance(0.3)) {
            const double amplitude_mm = random_.pick({0.0, 0.1, 5.0});
            line("boundary_noise = {{ amplitude_mm = {}, scale_mm = {} }}", amplitude_mm, random_.pick({0.01, 0.3, 10.0}));
        }
        const std::string graph =
            sites == "jittered-lattice" && random_.chance(0.4) ? "lattice" : random_.pick({"apollonius", "delaunay"});
        const std::string amount =
            random_.pick({"probability = 0.0", "probability = 0.3", "probability = 1.0", "grains = 1", "mean_grain_mm = 1.0"});
        line("sintering = {{ graph = \"{}\", {}, preference = \"{}\" }}", graph, amount,
             random_.pick({"none", "none", "misorientation", "area"}));
        const std::string orientation = random_.pick({"uniform", "uniform", "fibre"});
        line("orientation = {{ kind = \"{}\"{} }}", orientation,
             orientation == "fibre" ? ", axis = [0.1, 0.2, 1.0], spread_deg = 5.0" : "");
    }

    void add_crystal() {
        line("[crystal]\nsphere_diameter_nm = {}", random_.pick({50.0, 180.0, 250.0, 330.0, 1000.0}));
        line("n_sphere = {}", random_.pick({"1.0", "1.45", "4.0", "\"silica\"", "\"n.csv\""}));
        line("n_medium = {}", random_.pick({"1.0", "1.333", "\"water\"", "\"air\""}));
        line("coherence_length_um = {}", random_.pick({0.5, 25.0, 1.0e4}));
        line("stacking_fault_probability = {}", random_.pick({0.0, 0.2, 1.0}));
        line("mosaic_spread_deg = {}", random_.pick({0.0, 3.0, 30.0}));
    }

    void add_field(const char* key) {
        const std::string kind = random_.pick({"noise", "layers", "grains", "grid"});
        const double contrast = random_.pick({0.0, 0.5, 1.0});
        if (kind == "grid")
            line("{} = {{ kind = \"grid\", file = \"fields.vdb\", grid = \"sigma_a_scale\" }}", key);
        else
            line("{} = {{ kind = \"{}\", contrast = {}{} }}", key, kind, contrast,
                 kind == "grains" ? "" : fmt::format(", scale_mm = {}", random_.pick({0.05, 1.0, 100.0})));
    }

    void add_base_color() {
        line("[base_color]\nabsorber = \"{}\"",
             random_.pick({"carbon", "neutral", "iron-oxide", "pink-dye", "light-blue-dye", "absorber.csv"}));
        line("sigma_a_per_mm = {}", random_.pick({0.0, 0.25, 1.0e6}));
        line("sigma_s_rayleigh_400nm_per_mm = {}", random_.pick({0.0, 1.0, 1.0e3}));
        line("mie_phase = \"{}\"", random_.pick({"henyey-greenstein", "draine", "schlick", "lorenz-mie"}));
        line("mie_asymmetry = {}", random_.pick({-0.99, 0.0, 0.8}));
        line("mie_particle = \"{}\"", random_.pick({"vacancy", "sphere"}));
        if (random_.chance(0.3))
            line("defect_concentration = {}", random_.pick({0.0, 0.05, 0.2}));
        else
            line("sigma_s_mie_per_mm = {}", random_.pick({0.0, 2.0, 1.0e3}));
        if (random_.chance(0.3)) add_field("sigma_a_field");
        if (random_.chance(0.3)) add_field("sigma_s_rayleigh_field");
        if (random_.chance(0.3)) add_field("sigma_s_mie_field");
    }

    CaseRandom& random_;
    std::string text_;
};

}  // namespace

std::string random_recipe(CaseRandom& random) {
    return RecipeWriter(random).recipe();
}

}  // namespace opal::fuzz
