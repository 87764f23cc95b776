// SPDX-License-Identifier: GPL-3.0-or-later
#include "seed_files.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "formats/image.h"
#include "formats/opal_asset.h"
#include "program_run.h"

namespace opal::fuzz {
namespace {

constexpr const char* few_grains = "[grains]\nnum_sites = 40\nresolution = 28\nseed = 3\n";

const std::vector<SeedOpal> opals = {
    {"cells.vdb", true, true, false,
     "[shape]\nkind = \"cabochon\"\nsize_mm = [6.0, 5.0, 3.0]\n" + std::string(few_grains) +
         "[crystal]\nstacking_fault_probability = 0.2\nmosaic_spread_deg = 3.0\n"},
    {"fields.vdb", true, true, false,
     "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n" + std::string(few_grains) +
         "[crystal]\nn_sphere = \"silica\"\nn_medium = \"water\"\nsphere_diameter_nm = 330.0\n[base_color]\n"
         "sigma_s_mie_per_mm = 2.0\nmie_phase = \"draine\"\nsigma_s_rayleigh_400nm_per_mm = 1.0\n"
         "sigma_a_field = { kind = \"noise\", contrast = 0.9, scale_mm = 1.0 }\n"
         "sigma_s_mie_field = { kind = \"grains\", contrast = 0.5 }\n"},
    {"bezier.vdb", true, true, true,
     "[shape]\nkind = \"bezier\"\nsize_mm = [6.0, 5.0, 3.0]\n" + std::string(few_grains) +
         "[base_color]\nmie_phase = \"lorenz-mie\"\nsigma_s_mie_per_mm = 1.0\nabsorber = \"iron-oxide\"\n"},
    {"noisy.vdb", false, true, false,
     "[shape]\nkind = \"box\"\nsize_mm = [5.0, 4.0, 3.0]\n" + std::string(few_grains) +
         "tessellation = \"voronoi\"\nboundary_noise = { amplitude_mm = 0.1 }\n[base_color]\ndefect_concentration = 0.05\n"
         "absorber = \"pink-dye\"\n"},
    {"layers.vdb", false, true, false,
     "[shape]\nkind = \"ellipsoid\"\nsize_mm = [5.0, 4.0, 3.0]\n" + std::string(few_grains) +
         "tessellation = \"multiplicative\"\n[crystal]\nstacking_fault_probability = 1.0\ncoherence_length_um = 1000.0\n"
         "sphere_diameter_nm = 600.0\n[base_color]\nsigma_s_rayleigh_400nm_per_mm = 3.0\n"
         "sigma_s_rayleigh_field = { kind = \"layers\", contrast = 1.0, scale_mm = 1.0 }\n"},
    {"milky.vdb", true, true, false,
     "[shape]\nkind = \"cabochon\"\nsize_mm = [6.0, 5.0, 3.0]\n" + std::string(few_grains) +
         "tessellation = \"voronoi\"\n[base_color]\nmie_phase = \"schlick\"\nmie_asymmetry = -0.9\nsigma_s_mie_per_mm = 20.0\n"
         "sigma_a_per_mm = 0.0\n"},
    {"sites.vdb", true, false, false,
     "[shape]\nkind = \"mesh\"\nfile = \"cube.obj\"\n" + std::string(few_grains) + "[output]\ngrids = [\"shape\", \"sites\"]\n"},
    {"teapot.vdb", true, true, true,
     "[shape]\nkind = \"bezier\"\npatches = \"teapot\"\nlongest_mm = 6.0\n" + std::string(few_grains)},
    {"voxels.vdb", false, true, false,
     "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n" + std::string(few_grains) + "[output]\ngrids = [\"grain_id\"]\n"},
    {"foreign.vdb", false, true, false, ""},
};

/// As a client without integer grids writes it.
void write_foreign_opal(const std::filesystem::path& path) {
    initialize_openvdb();
    auto ids = openvdb::FloatGrid::create(0.0f);
    ids->setName("grain_id");
    ids->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    auto accessor = ids->getAccessor();
    for (int x = -8; x <= 8; ++x)
        for (int y = -8; y <= 8; ++y)
            for (int z = -6; z <= 6; ++z)
                if (x * x + y * y + 2 * z * z < 64)
                    accessor.setValueOn({x, y, z}, float(1 + (x > 0) + 2 * (y > 0) + 4 * (z > 0)));
    openvdb::io::File file(path.string());
    file.write({ids});
    file.close();
}

struct Cube {
    double vertex[8][3];
    int triangle[12][3];
};

Cube make_cube() {
    Cube cube = {};
    for (int v = 0; v < 8; ++v)
        for (int axis = 0; axis < 3; ++axis) cube.vertex[v][axis] = (v >> (2 - axis) & 1) ? 2.0 : -2.0;
    const int quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (int q = 0; q < 6; ++q)
        for (int half = 0; half < 2; ++half)
            for (int k = 0; k < 3; ++k) cube.triangle[2 * q + half][k] = quads[q][k == 0 ? 0 : k + half];
    return cube;
}

void write_meshes(const std::filesystem::path& folder) {
    const Cube cube = make_cube();
    std::string vertices, faces[12], stl = "solid cube\n", ply;
    for (const auto& v : cube.vertex) {
        vertices += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
        ply += fmt::format("{} {} {}\n", v[0], v[1], v[2]);
    }
    std::string ply_faces;
    for (int t = 0; t < 12; ++t) {
        const int* const c = cube.triangle[t];
        faces[t] = fmt::format("f {} {} {}\n", c[0] + 1, c[1] + 1, c[2] + 1);
        ply_faces += fmt::format("3 {} {} {}\n", c[0], c[1], c[2]);
        stl += "facet normal 0 0 0\nouter loop\n";
        for (int k = 0; k < 3; ++k)
            stl += fmt::format("vertex {} {} {}\n", cube.vertex[c[k]][0], cube.vertex[c[k]][1], cube.vertex[c[k]][2]);
        stl += "endloop\nendfacet\n";
    }
    std::string closed = vertices, open = vertices;
    for (int t = 0; t < 12; ++t) closed += faces[t];
    for (int t = 0; t < 10; ++t) open += faces[t];
    write_bytes(folder / "cube.obj", closed);
    write_bytes(folder / "open.obj", open);
    write_bytes(folder / "cube.stl", stl + "endsolid cube\n");
    write_bytes(folder / "cube.ply",
                "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 12\nproperty list uchar int vertex_indices\nend_header\n" +
                    ply + ply_faces);
}

void write_tables(const std::filesystem::path& folder) {
    write_bytes(folder / "n.csv", "wavelength_nm,n\n400,1.6\n500,1.55\n700,1.5\n");
    write_bytes(folder / "nk.csv", "wavelength_nm,n,k\n400,1.6,2\n500,1.0,3\n700,0.2,4\n");
    write_bytes(folder / "light.csv", "wavelength_nm,power\n400,1\n500,0\n700,2\n");
    write_bytes(folder / "absorber.csv", "wavelength_nm,sigma\n400,3\n550,1\n700,0.5\n");
    std::string sites = "x,y,z\n", weights;
    for (int i = 0; i < 27; ++i) {
        sites += fmt::format("{},{},{}\n", i % 3 - 1, i / 3 % 3 - 1 + 0.1 * (i % 2), i / 9 - 1);
        weights += fmt::format("{}\n", 0.01 * (i % 7));
    }
    write_bytes(folder / "sites.csv", sites);
    write_bytes(folder / "weights.csv", weights);
    write_bytes(folder / "orientations.csv", "grain,x,y,z,w\n1,0,0,0,1\n2,0.6,0,0,0.8\n");
}

void write_environments(const std::filesystem::path& folder) {
    Image image;
    image.width = 16;
    image.height = 8;
    image.channel_names = {"R", "G", "B"};
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n";
    for (int i = 0; i < 16 * 8; ++i) {
        const int exponent = i % 37 == 0 ? 134 : 127;
        for (const int mantissa : {40 + i, 200 - i, 90 + i / 2}) {
            image.pixels.push_back(std::ldexp(float(mantissa), exponent - 136));
            hdr += char(mantissa);
        }
        hdr += char(exponent);
    }
    write_exr(folder / "env.exr", image);
    write_bytes(folder / "env.hdr", hdr);
    for (float& value : image.pixels) value = std::min(1.0f, value);
    write_png(folder / "env.png", image);
}

/// A program's run that has to succeed.
void must_run(const std::vector<std::string>& command) {
    const ProgramRun run = run_program(command);
    if (run.exit_code != 0)
        throw std::runtime_error(fmt::format("seed file: {} ended with {}: {}", command[0], run.exit_code, run.text));
}

}  // namespace

const std::vector<SeedOpal>& seed_opals() {
    return opals;
}

void make_seed_files(const std::filesystem::path& folder) {
    write_meshes(folder);
    write_tables(folder);
    write_environments(folder);
    for (const SeedOpal& opal : opals) {
        const std::filesystem::path file = folder / opal.file;
        if (opal.recipe.empty()) {
            write_foreign_opal(file);
            continue;
        }
        std::filesystem::path recipe = file;
        write_bytes(recipe.replace_extension(".toml"), opal.recipe);
        must_run({"opal-model", "build", recipe.string(), "-o", file.string(), "--threads", "1"});
    }
    const std::string still = (folder / "still.toml").string();
    write_bytes(still,
                "[render]\nwidth = 12\nheight = 9\nsamples = 4\n[camera]\nposition_mm = [0.0, -32.0, 24.0]\n[environment]\n"
                "kind = \"constant\"\n[film]\naovs = [\"object_id\", \"depth\", \"normal\"]\n[[material]]\nname = \"ground\"\n"
                "kind = \"diffuse\"\n[[object]]\nkind = \"opal\"\nfile = \"cells.vdb\"\n[[object]]\nkind = \"plane\"\n"
                "material = \"ground\"\ntranslate_mm = [0.0, 0.0, -3.0]\n");
    const auto render = [&](const char* output, std::vector<std::string> more) {
        more.insert(more.begin(), {"opal-render", still, "-o", (folder / output).string(), "--threads", "1"});
        must_run(more);
    };
    render("still.exr", {"--spp", "2", "--keep-checkpoint"});
    render("part_a.exr", {"--samples", "0:2"});
    render("part_b.exr", {"--samples", "2:4"});
}

std::string read_bytes(const std::filesystem::path& path) {
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    return bytes.str();
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace opal::fuzz
