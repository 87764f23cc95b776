// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_text.h"

#include <fmt/format.h>

#include "seed_files.h"

namespace opal::fuzz {
namespace {

constexpr int width = 8, height = 6;

struct Material {
    std::string name;
    bool transparent = false;
};

class SceneWriter {
  public:
    explicit SceneWriter(CaseRandom& random) : random_(random) {}

    std::string scene() {
        add_render();
        add_camera();
        add_film();
        add_environment();
        add_opal_settings();
        add_materials();
        add_objects();
        add_lights();
        add_animation();
        return std::move(text_);
    }

  private:
    template <typename... Values>
    void line(fmt::format_string<Values...> format, Values&&... values) {
        text_ += fmt::format(format, std::forward<Values>(values)...) + '\n';
    }
    // One draw per statement throughout: the order of a call's arguments is the compiler's.
    std::string place(double x_low, double x_high, double y_low, double y_high, double z_low, double z_high) {
        const double x = random_.between(x_low, x_high);
        const double y = random_.between(y_low, y_high);
        const double z = random_.between(z_low, z_high);
        return fmt::format("[{}, {}, {}]", x, y, z);
    }
    std::string vector(double reach) { return place(-reach, reach, -reach, reach, -reach, reach); }

    void add_render() {
        line("[render]\nwidth = {}\nheight = {}\nsamples = 2", width, height);
        line("max_bounces = {}", random_.pick({1, 2, 8, 64, 64, 64, 500}));
        line("seed = {}", random_.word());
        line("sampler = \"{}\"", random_.pick({"sobol", "stratified", "independent"}));
        line("filter = \"{}\"", random_.pick({"tent", "box", "gaussian", "blackman-harris"}));
        line("light_sampling = \"{}\"", random_.pick({"both", "connections", "scattering"}));
        line("roulette = {}", random_.chance(0.8));
        guided_ = random_.chance(0.2);
        line("guided = {}", guided_);
        if (random_.chance(0.3)) line("filter_radius_px = {}", random_.pick({0.01, 0.5, 3.0, 16.0}));
        if (random_.chance(0.3)) {
            const int x0 = random_.integer(0, width - 1);
            const int y0 = random_.integer(0, height - 1);
            const int x1 = random_.integer(x0 + 1, width);
            line("crop = [{}, {}, {}, {}]", x0, y0, x1, random_.integer(y0 + 1, height));
        }
        if (random_.chance(0.1)) line("noise = {}", random_.pick({0.01, 0.5, 1.0}));
    }

    void add_camera() {
        line("[camera]");
        if (random_.chance(0.8)) {
            line("position_mm = {}", place(-10.0, 10.0, -33.0, -27.0, -5.0, 20.0));
            line("target_mm = {}", vector(2.0));
        } else {  // among the objects, or in one
            line("position_mm = {}", vector(2.5));
            line("target_mm = {}", place(-9.0, 9.0, 9.7, 9.7, -3.0, 3.0));
        }
        if (random_.chance(0.25))
            line("kind = \"orthographic\"\nview_height_mm = {}", random_.pick({0.1, 10.0, 50.0}));
        else
            line("vertical_fov_deg = {}", random_.pick({0.01, 5.0, 20.0, 60.0, 170.0}));
        if (random_.chance(0.3)) line("aperture_radius_mm = {}", random_.pick({0.01, 1.0, 20.0}));
        if (random_.chance(0.3)) line("focus_mm = {}", random_.pick({0.01, 1.0, 30.0, 1.0e6}));
        if (random_.chance(0.2)) line("up = {}", vector(1.0));
    }

    void add_film() {
        line("[film]\nspectral = {}", random_.chance(0.3));
        line("exposure_ev = {}", random_.between(-3.0, 3.0));
        line("tone = \"{}\"", random_.pick({"filmic", "srgb", "none"}));
        std::string names;
        for (const char* name : {"object_id", "grain_id", "depth", "normal", "albedo", "hkl", "sample_count", "variance"})
            if (random_.chance(0.3)) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
        line("aovs = [{}]", names);
        if (random_.chance(0.2))
            line("white_temperature_k = {}", random_.integer(2000, 25000));
        else
            line("white = \"{}\"", random_.pick({"A", "E", "D65"}));
    }

    void add_illuminant() {
        const std::string kind = random_.pick({"", "", "D65", "A", "E", "blackbody", "led", "file"});
        if (kind == "file")
            line("illuminant_file = \"light.csv\"");
        else if (!kind.empty())
            line("illuminant = \"{}\"", kind);
        if (kind == "blackbody") line("temperature_k = {}", random_.integer(1000, 25000));
        if (kind == "led") line("temperature_k = {}", random_.integer(2700, 6500));
    }

    void add_environment() {
        line("[environment]");
        const std::string kind = random_.pick({"studio", "constant", "tent", "env.exr", "env.exr", "env.hdr", "env.png"});
        line("{} = \"{}\"", kind.starts_with("env") ? "file" : "kind", kind);
        line("radiance = {}", random_.pick({0.0, 1.0, 1.0, 1.0, 1.0e3, 1.0e9}));
        line("rotate_deg = {}", random_.between(-400.0, 400.0));
        add_illuminant();
        line("[color]\nupsampling = \"{}\"", random_.pick({"jakob-hanika", "smits", "basis"}));
    }

    void add_opal_settings() {
        grains_ = random_.pick({"auto", "auto", "cells", "voxels", "sphere-tracing", "hyperboloid"});
        line("[opal]\ngrains = \"{}\"", grains_);
        line("diffraction = \"{}\"", random_.pick({"two-beam", "two-beam", "two-beam", "ewald-fresnel", "laue", "none"}));
        line("companions = {}", random_.integer(0, 7));
        line("dispersion = \"{}\"", random_.pick({"full", "bands", "none"}));
        line("majorants = \"{}\"", random_.pick({"local", "global"}));
        line("tracking = \"{}\"", random_.pick({"residual", "ratio"}));
        line("max_odds = {}", random_.pick({1.0, 400.0, 400.0, 1.0e6}));
        line("ewald_tolerance = {}", random_.pick({0.01, 0.5, 1.0e-6}));
    }

    double roughness() { return random_.pick({0.0, 0.001, 0.01, 0.1, 0.5, 1.0}); }

    void add_medium() {
        // Photons for guides, and flights through a grid, take a step per free path; the ends of what is allowed would take
        // minutes.
        const bool grid = random_.chance(0.3);
        const bool thin = grid || guided_;
        line("medium.sigma_s_per_mm = {}", random_.pick({0.0, 0.1, 1.0, 30.0, thin ? 30.0 : 1.0e4}));
        line("medium.sigma_a_per_mm = {}", random_.pick({0.0, 0.1, 1.0, thin ? 100.0 : 1.0e6}));
        line("medium.asymmetry = {}", random_.pick({0.0, -0.99, 0.5, 0.99}));
        if (grid)
            line("medium.density_file = \"fields.vdb\"\nmedium.density_grid = \"sigma_a_scale\"\nmedium.density_scale = {}",
                 random_.pick({0.0, 1.0, 3.0}));
        if (random_.chance(0.3))
            line("medium.absorber = \"{}\"",
                 random_.pick({"carbon", "iron-oxide", "pink-dye", "light-blue-dye", "absorber.csv"}));
    }

    void add_materials() {
        const int count = random_.integer(1, 4);
        for (int m = 0; m < count; ++m) {
            const std::string kind = random_.pick({"diffuse", "dielectric", "dielectric", "conductor", "plastic"});
            materials_.push_back({fmt::format("m{}", m), kind == "dielectric"});
            line("[[material]]\nname = \"m{}\"\nkind = \"{}\"", m, kind);
            if (kind == "diffuse" || kind == "plastic")
                line("albedo = {}", random_.pick({"0.0", "1.0", "[0.9, 0.1, 0.0]", "0.37", "[0.0, 0.0, 1.0]"}));
            if (kind == "dielectric" || kind == "plastic")
                line("n = {}",
                     random_.pick({"1.0", "1.5", "4.0", "1.33", "\"silica\"", "\"water\"", "\"air\"", "\"resin\"", "\"n.csv\""}));
            if (kind != "diffuse") line("roughness = {}", roughness());
            if (kind == "conductor")
                line("metal = \"{}\"",
                     random_.pick({"gold", "silver", "copper", "platinum", "rhodium", "gold-silver", "nk.csv"}));
            if (kind == "dielectric" && random_.chance(0.6)) add_medium();
        }
    }

    /// One that shows its grains by the scene's method.
    const SeedOpal& fitting_opal() {
        while (true) {
            const SeedOpal& opal = random_.pick(seed_opals());
            if (grains_ == "auto" || (grains_ == "voxels" ? opal.has_voxels : opal.has_cells)) return opal;
        }
    }

    void add_placement(bool plane) {
        if (plane) {
            line("translate_mm = [0.0, 0.0, {}]", random_.between(-8.0, -3.5));
            return;
        }
        line("translate_mm = {}", vector(2.5));
        if (random_.chance(0.6)) line("rotate_deg = {}", vector(180.0));
        if (random_.chance(0.5)) line("scale = {}", random_.pick({0.0001, 0.1, 0.5, 1.7, 2.3}));
    }

    void add_opal() {
        const SeedOpal& opal = fitting_opal();
        line("file = \"{}\"", opal.file);
        line("roughness = {}", random_.chance(0.6) ? 0.0 : roughness());
        line("orientation_seed = {}", random_.below(1000));
        if (opal.has_patches && random_.chance(0.5)) line("exact = true");
    }

    void add_solid(const std::string& kind, const Material& material) {
        line("material = \"{}\"", material.name);
        if (kind == "mesh") {
            line("file = \"{}\"", material.transparent ? random_.pick({"cube.obj", "cube.ply", "cube.stl"})
                                                       : random_.pick({"cube.obj", "open.obj"}));
            if (random_.chance(0.5)) line("smooth_normals_deg = {}", random_.pick({0.0, 40.0, 91.0, 180.0}));
        }
        if (kind == "sphere" || kind == "cylinder") line("radius_mm = {}", random_.between(0.3, 4.0));
        if (kind == "cylinder") line("height_mm = {}", random_.between(0.3, 6.0));
        if (kind == "cylinder" && random_.chance(0.4)) line("bevel_mm = {}", random_.pick({0.0, 0.1, 0.3}));
    }

    void add_objects() {
        const int count = random_.integer(1, 6);
        for (int i = 0; i < count; ++i) {
            std::string kind = random_.pick({"opal", "opal", "mesh", "sphere", "sphere", "cylinder", "plane"});
            const Material& material = random_.pick(materials_);
            if (kind == "plane" && material.transparent) kind = "cylinder";
            line("[[object]]\nkind = \"{}\"\nname = \"o{}\"", kind, i);
            if (kind == "opal")
                add_opal();
            else
                add_solid(kind, material);
            if ((kind == "opal" || material.transparent) && random_.chance(0.5)) line("priority = {}", random_.integer(-3, 3));
            add_placement(kind == "plane");
        }
    }

    void add_lights() {
        const int count = random_.pick({0, 0, 1, 2, 4});
        for (int i = 0; i < count; ++i) {
            const std::string kind = random_.pick({"area", "disk", "sphere", "spot", "sun"});
            line("[[light]]\nkind = \"{}\"", kind == "disk" ? "area" : kind);
            if (kind == "sun") {
                line("elevation_deg = {}", random_.between(-90.0, 90.0));
                line("azimuth_deg = {}", random_.between(-400.0, 400.0));
                line("angular_diameter_deg = {}", random_.pick({0.001, 0.53, 10.0, 90.0}));
                line("irradiance = {}", random_.pick({0.0, 3.0, 1.0e9}));
            } else {
                const bool above = random_.chance(0.5);
                line("position_mm = {}", place(-60.0, 60.0, -60.0, 60.0, above ? 20.0 : -40.0, above ? 60.0 : -20.0));
                line("radiance = {}", random_.pick({0.0, 100.0, 1.0e12}));
            }
            if (kind == "area") line("width_mm = {}\nheight_mm = 2.0", random_.pick({0.001, 3.0}));
            if (kind == "sphere" || kind == "disk" || kind == "spot")
                line("radius_mm = {}", random_.pick({0.001, 0.1, 1.0, 3.0}));
            if (kind == "area" || kind == "disk" || kind == "spot") line("target_mm = {}", vector(3.0));
            if (kind == "spot") line("cone_deg = {}", random_.pick({0.01, 40.0, 180.0}));
            if (kind == "spot") line("blend = {}", random_.pick({0.0, 0.15, 1.0}));
            if (random_.chance(0.5)) line("color = {}", random_.pick({"[1.0, 0.0, 0.0]", "0.5", "0.0", "[0.2, 0.9, 1.0]"}));
            if (random_.chance(0.4)) line("visible = false");
            add_illuminant();
        }
    }

    void add_animation() {
        if (!random_.chance(0.05)) return;
        line("[animation]\nframes = 2\nturntable_deg = {}", random_.between(-100.0, 100.0));
        line("light_sweep_deg = {}", random_.between(-100.0, 100.0));
        line("camera_orbit_deg = {}", random_.between(-100.0, 100.0));
        line("center_mm = {}", vector(2.0));
        if (random_.chance(0.5)) line("turntable_objects = [\"o0\"]");
    }

    CaseRandom& random_;
    std::string text_, grains_;
    bool guided_ = false;
    std::vector<Material> materials_;
};

}  // namespace

std::string random_scene(CaseRandom& random) {
    return SceneWriter(random).scene();
}

}  // namespace opal::fuzz
