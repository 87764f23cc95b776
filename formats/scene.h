// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/material.h"

namespace opal {

enum class SamplerKind { sobol, stratified, independent };
enum class LightSamplingKind { both, connections, scattering };
enum class FilterKind { tent, box, gaussian, blackman_harris };
enum class CameraKind { perspective, orthographic };
enum class EnvironmentKind { studio, constant, file, tent };
enum class IlluminantKind { d65, a, equal_energy, blackbody, led, file };
enum class Upsampling { jakob_hanika, smits, basis };
enum class DiffractionModel { two_beam, ewald_fresnel, laue, none };
enum class Dispersion { full, bands, none };
enum class LightKind { area, sphere, spot, sun };
enum class MajorantKind { local, global };
/// Through coefficients that vary. residual: what is least everywhere in a cell in closed form, only the rest collides; ratio:
/// all of it collides.
enum class TrackingKind { residual, ratio };
enum class GrainsKind { automatic, cells, voxels, sphere_tracing, hyperboloid };
/// How the PNG shows linear light: filmic has a shoulder for highlights, srgb is the plain encoding, cut at 1, none leaves the
/// values linear, cut at 1.
enum class ToneCurve { filmic, srgb, none };
enum class ObjectKind { opal, mesh, plane, sphere, cylinder };

/// Pixels [x0, x1) x [y0, y1) of a picture.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    bool operator==(const PixelWindow&) const = default;
};

struct RenderDescription {
    int width = 960;
    int height = 720;
    int samples = 256;
    double noise = 0.0;  ///< relative error of luminance and chroma at which a place gets no more samples; 0: samples everywhere
    int max_bounces = 64;
    bool roulette = true;  ///< paths that carry little end at random, those kept weigh more
    std::uint64_t seed = 1;
    SamplerKind sampler = SamplerKind::sobol;
    LightSamplingKind light_sampling = LightSamplingKind::both;
    bool guided = false;  ///< half of a path's first two scatterings are drawn towards where photons came from
    FilterKind filter = FilterKind::tent;
    double filter_radius_px = 1.0;
    std::optional<PixelWindow> crop;  ///< the part of the picture that is drawn; unset: all

    PixelWindow window() const { return crop ? *crop : PixelWindow{0, 0, width, height}; }
};

struct CameraDescription {
    CameraKind kind = CameraKind::perspective;
    std::array<double, 3> position_mm = {0.0, -45.0, 30.0};
    std::array<double, 3> target_mm = {0.0, 0.0, 2.0};
    std::array<double, 3> up = {0.0, 0.0, 1.0};
    double vertical_fov_deg = 20.0;
    double view_height_mm = 20.0;  ///< orthographic: height of the picture in the scene
    double aperture_radius_mm = 0.0;
    double focus_mm = 0.0;  ///< distance to the plane in focus; 0 = at the target
};

struct FilmDescription {
    bool spectral = false;  ///< 48 layers of 10 nm beside the RGB
    std::vector<std::string> aovs;
    double exposure_ev = 0.0;
    IlluminantKind white = IlluminantKind::d65;  ///< what is shown as white; d65, a, equal_energy or blackbody
    double white_temperature_k = 6500.0;         ///< blackbody
    ToneCurve tone = ToneCurve::filmic;
};

struct EnvironmentDescription {
    EnvironmentKind kind = EnvironmentKind::studio;
    std::filesystem::path file;
    double radiance = 1.0;                            ///< scale of the whole environment
    double rotate_deg = 0.0;                          ///< counter-clockwise about +Z, seen from above
    IlluminantKind illuminant = IlluminantKind::d65;  ///< spectrum of what the picture shows as white
    double temperature_k = 4000.0;                    ///< blackbody, led
    std::filesystem::path illuminant_file;            ///< .csv
};

/// A light beside the environment. Radiance is in the film's unit: 1 shows as white.
struct LightDescription {
    LightKind kind = LightKind::area;
    std::array<double, 3> position_mm = {0.0, 0.0, 100.0};  ///< centre
    std::array<double, 3> target_mm = {0.0, 0.0, 0.0};      ///< area, spot: what the light looks at
    std::array<double, 3> up = {0.0, 0.0, 1.0};             ///< rectangle: its height runs this way
    bool disk = false;                                      ///< area: a disk of `radius_mm` instead of a rectangle
    double width_mm = 20.0, height_mm = 20.0;               ///< rectangle
    double radius_mm = 1.0;                                 ///< disk, sphere, spot
    double cone_deg = 40.0;                                 ///< spot: full angle of the cone, beyond which it is dark
    double blend = 0.15;                                    ///< spot: part of the cone's half angle over which it fades
    double elevation_deg = 45.0;                            ///< sun: above the horizon
    double azimuth_deg = 0.0;                               ///< sun: counter-clockwise from +X, seen from above
    double angular_diameter_deg = 0.53;                     ///< sun
    double irradiance = 3.141592653589793;            ///< sun: on a surface that faces it; pi makes a white surface show as white
    double radiance = 100.0;                          ///< all but the sun
    std::array<double, 3> color = {1.0, 1.0, 1.0};    ///< linear sRGB, 0 to 1, times the illuminant
    IlluminantKind illuminant = IlluminantKind::d65;  ///< its own, whatever the environment's
    double temperature_k = 4000.0;                    ///< blackbody, led
    std::filesystem::path illuminant_file;            ///< .csv
    bool visible = true;                              ///< to the camera directly
};

struct OpalDescription {
    DiffractionModel diffraction = DiffractionModel::two_beam;
    double ewald_tolerance = 0.01;  ///< ewald-fresnel: largest deviation of |w + (lambda/n) G| from 1
    double max_odds = 400.0;        ///< reflection odds of one grain saturate here; reflectance is low by at most 1 / max_odds
    Dispersion dispersion =
        Dispersion::full;  ///< full: bands and refraction; bands: diffraction alone; none: indices at 589.3 nm
    MajorantKind majorants = MajorantKind::local;
    TrackingKind tracking = TrackingKind::residual;
    GrainsKind grains =
        GrainsKind::automatic;  ///< automatic: cells where the file's sites describe the grains exactly, else voxels
    int companions = 3;         ///< wavelengths that travel with the hero, 0 to 7

    bool operator==(const OpalDescription&) const = default;
};

/// The least roughness of a surface that is not smooth.
inline constexpr double min_scene_roughness = 1.0e-3;

struct ObjectDescription {
    ObjectKind kind = ObjectKind::opal;
    std::string name;            ///< by which an animation refers to it
    std::filesystem::path file;  ///< opal: the .vdb; mesh: OBJ, PLY, STL or glTF
    std::string material;        ///< name of a [[material]]; unused for an opal
    std::array<double, 3> translate_mm = {0.0, 0.0, 0.0};
    std::array<double, 3> rotate_deg = {0.0, 0.0, 0.0};  ///< about X, then Y, then Z
    double scale = 1.0;
    double radius_mm = 10.0;  ///< sphere, cylinder
    double height_mm = 2.0;   ///< cylinder: from z = 0 down to -height, so that things stand on it
    double bevel_mm = 0.3;    ///< cylinder: rounding of its upper edge
    double size_mm = 2000.0;  ///< plane: edge of the square
    int priority = 0;  ///< opal, dielectric: where bodies overlap the one of higher priority is there; of equal ones the later
    std::optional<double> smooth_normals_deg;  ///< mesh: faces that meet at less share a normal; unset: as the file says
    double roughness = 0.0;                    ///< opal: GGX alpha of its surface; 0: polished
    bool exact = false;                        ///< opal: its Bezier patches themselves, not the level set's surface
    std::uint64_t orientation_seed = 1;        ///< opal made elsewhere: seed of its grains' orientations

    bool operator==(const ObjectDescription&) const = default;
};

/// How colours of the scene become spectra.
struct ColorDescription {
    Upsampling upsampling = Upsampling::jakob_hanika;
};

/// Steady turns from frame to frame; the first frame is the scene as it stands. Angles are counter-clockwise about +Z, seen from
/// above.
struct AnimationDescription {
    int frames = 1;
    double turntable_deg = 0.0;                  ///< per frame, about the vertical axis through `center_mm`
    std::vector<std::string> turntable_objects;  ///< names; empty: every opal
    std::array<double, 3> center_mm = {0.0, 0.0, 0.0};
    double light_sweep_deg = 0.0;   ///< per frame: the environment, and lights about `center_mm`
    double camera_orbit_deg = 0.0;  ///< per frame, about the vertical axis through the camera's target
};

/// What opal-render draws: a validated scene.toml.
struct SceneDescription {
    RenderDescription render;
    CameraDescription camera;
    FilmDescription film;
    ColorDescription color;
    EnvironmentDescription environment;
    OpalDescription opal;
    std::vector<MaterialDescription> materials;
    std::vector<ObjectDescription> objects;
    std::vector<LightDescription> lights;
    AnimationDescription animation;
};

/// Reads and validates. Throws InputError located at file:line:column.
SceneDescription read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);
/// The same from text; `name` stands for the file in messages and gives the folder of relative paths.
SceneDescription parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides);

/// The scene with every default spelled out, as TOML that `parse_scene` reads back.
std::string scene_to_toml(const SceneDescription& scene);

}  // namespace opal
