// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz_case.h"

#include <fmt/format.h>

#include "case_random.h"
#include "entry_points.h"
#include "mutations.h"
#include "outcome.h"
#include "program_run.h"
#include "recipe_text.h"
#include "scene_text.h"
#include "seed_files.h"

namespace opal::fuzz {
namespace {

const std::vector<std::string> names = {"scene",   "recipe", "scene-text", "recipe-text", "opal", "opal-tools", "checkpoint",
                                        "develop", "merge",  "compare",    "environment", "mesh", "table"};

/// How often each kind comes among damaged files.
constexpr Kind turns[] = {Kind::scene_text, Kind::recipe_text, Kind::opal,        Kind::opal_tools,  Kind::checkpoint,
                          Kind::develop,    Kind::scene_text,  Kind::opal,        Kind::merge,       Kind::opal_tools,
                          Kind::compare,    Kind::scene_text,  Kind::recipe_text, Kind::opal,        Kind::environment,
                          Kind::mesh,       Kind::table,       Kind::opal_tools,  Kind::recipe_text, Kind::scene_text};

/// Far from those that make the scenes, so that a mutation does not depend on how many numbers a scene takes.
constexpr std::uint64_t other_text = std::uint64_t(1) << 40;

class Case {
  public:
    Case(const std::filesystem::path& folder, std::uint64_t seed, std::uint64_t index)
        : folder_(folder), seed_(seed), index_(index), random_(seed, index) {}

    CaseOutcome run(Kind kind) {
        switch (kind) {
            case Kind::scene:
                return render_text(random_scene(random_), {}, false);
            case Kind::scene_text:
                return mutated_scene();
            case Kind::recipe:
                return build_text(random_recipe(random_), {});
            case Kind::recipe_text:
                return mutated_recipe();
            case Kind::opal:
                return render_opal();
            case Kind::opal_tools:
                return look_at_opal();
            case Kind::checkpoint:
                return resume();
            case Kind::develop:
            case Kind::merge:
            case Kind::compare:
                return use_picture(kind);
            case Kind::environment:
                return environment();
            case Kind::mesh:
                return mesh();
            case Kind::table:
                break;
        }
        return table();
    }

  private:
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    /// Runs a program on the case's files; adds what it did wrong.
    ProgramRun program(const std::vector<std::string>& command, bool may_refuse = true) {
        const ProgramRun run = run_program(command);
        judge_run(run, may_refuse, outcome_);
        return run;
    }

    CaseOutcome render_text(const std::string& text, const std::vector<std::string>& flags, bool may_refuse) {
        write_bytes(at("case.toml"), text);
        std::vector<std::string> command = {"opal-render", at("case.toml"), "-o",  at("out.exr"), "--threads",
                                            "1",           "--checkpoint",  "off", "--stats",     at("out.json")};
        command.insert(command.end(), flags.begin(), flags.end());
        if (program(command, may_refuse).exit_code == 0)
            judge_rendered(folder_, outcome_);
        else
            judge_nothing_left(folder_, outcome_);
        return outcome_;
    }

    CaseOutcome mutated_scene() {
        CaseRandom other(seed_, index_ + other_text);
        const std::string text = random_scene(random_);
        // Small and short, whatever the text says: what takes long by right is no hang.
        std::vector<std::string> flags = {"--spp", "1", "--time", "2s", "--set", "render.max_bounces=20"};
        for (const char* key : {"render.width=4", "render.height=3", "animation.frames=1"})
            flags.insert(flags.end(), {"--set", key});
        const std::string mutated = mutated_text(text, random_scene(other), random_);
        check_scene_text(mutated);
        return render_text(mutated, flags, true);
    }

    CaseOutcome build_text(const std::string& text, const std::vector<std::string>& flags) {
        write_bytes(at("case.toml"), text);
        std::vector<std::string> command = {"opal-model", "build", at("case.toml"), "-o",          at("out.vdb"),
                                            "--threads",  "1",     "--report",      at("out.json")};
        command.insert(command.end(), flags.begin(), flags.end());
        if (program(command).exit_code == 0)
            program({"opal-model", "check", at("out.vdb")}, false);
        else
            judge_nothing_left(folder_, outcome_);
        return outcome_;
    }

    CaseOutcome mutated_recipe() {
        CaseRandom other(seed_, index_ + other_text);
        const std::string text = random_recipe(random_);
        const std::string mutated = mutated_text(text, random_recipe(other), random_);
        check_recipe_text(mutated);
        std::vector<std::string> flags = {"--set", "grains.resolution=12"};
        if (mutated.find("sites.csv") == std::string::npos) flags.insert(flags.end(), {"--set", "grains.num_sites=20"});
        return build_text(mutated, flags);
    }

    void damage_opal(const SeedOpal& opal) {
        // OpenVDB trusts the bytes of files without a checksum.
        if (opal.recipe.empty() || random_.chance(0.5))
            write_mutated_grids(folder_ / opal.file, folder_ / "case.vdb", random_);
        else
            write_bytes(at("case.vdb"), mutated_bytes(read_bytes(folder_ / opal.file), random_));
    }

    CaseOutcome render_opal() {
        const SeedOpal& opal = random_.pick(seed_opals());
        damage_opal(opal);
        std::string scene =
            "[render]\nwidth = 4\nheight = 3\nsamples = 1\nmax_bounces = 50\n[environment]\nkind = \"constant\"\n[camera]\n"
            "position_mm = [0.0, -32.0, 24.0]\n[film]\naovs = [\"grain_id\", \"hkl\"]\n";
        if (random_.chance(0.15)) {
            scene +=
                "[[material]]\nname = \"m\"\nkind = \"dielectric\"\nmedium = { sigma_s_per_mm = 1.0, density_file = "
                "\"case.vdb\", "
                "density_grid = \"sigma_a_scale\" }\n[[object]]\nkind = \"sphere\"\nradius_mm = 2.0\nmaterial = \"m\"\n";
        } else {
            scene +=
                fmt::format("[opal]\ngrains = \"{}\"\n", random_.pick({"auto", "auto", "cells", "voxels", "sphere-tracing"}));
            scene += fmt::format("[[object]]\nkind = \"opal\"\nfile = \"case.vdb\"\nexact = {}\n",
                                 opal.has_patches && random_.chance(0.7));
        }
        return render_text(scene, {}, true);
    }

    CaseOutcome look_at_opal() {
        damage_opal(random_.pick(seed_opals()));
        switch (random_.below(4)) {
            case 0:
                program({"opal-model", "info", at("case.vdb"), "--json"});
                break;
            case 1:
                if (program({"opal-model", "section", at("case.vdb"), "--axis", random_.pick({"x", "y", "z"}), "--color",
                             random_.pick({"grain", "weight", "orientation"}), "--size", "64", "-o", at("out.png")})
                        .exit_code != 0)
                    judge_nothing_left(folder_, outcome_);
                break;
            default:
                program({"opal-model", "check", at("case.vdb")});
        }
        return outcome_;
    }

    CaseOutcome resume() {
        const std::string mutated = mutated_bytes(read_bytes(folder_ / "still.checkpoint"), random_);
        check_checkpoint_bytes(mutated);
        write_bytes(at("out.checkpoint"), mutated);
        std::filesystem::copy_file(folder_ / "out.checkpoint", folder_ / "case.checkpoint",
                                   std::filesystem::copy_options::overwrite_existing);
        if (program({"opal-render", at("still.toml"), "-o", at("out.exr"), "--threads", "1", "--spp", "4", "--resume", "--stats",
                     at("out.json")})
                .exit_code == 0)
            judge_rendered(folder_, outcome_);
        return outcome_;
    }

    CaseOutcome use_picture(Kind kind) {
        const std::string from = at(kind == Kind::merge ? "part_a.exr" : "still.exr");
        if (random_.chance(0.6))
            write_mutated_picture(from, at("case.exr"), random_);
        else
            write_bytes(at("case.exr"), mutated_bytes(read_bytes(from), random_));
        std::vector<std::string> command;
        if (kind == Kind::develop) {
            command = {"opal-render", "develop", at("case.exr"), "-o", at("out.png")};
            for (const char* flag : {"--exposure=1", "--white=A", "--blacken", "--crop=1,2,5,6"})
                if (random_.chance(0.25)) command.emplace_back(flag);
        } else if (kind == Kind::merge) {
            command = {"opal-render", "merge", at("case.exr"), at("part_b.exr"), "-o", at("out.exr")};
        } else {
            command = {"opal-render", "compare", at("case.exr"), at("still.exr"), "--difference", at("out.exr")};
            if (random_.chance(0.5)) std::swap(command[2], command[3]);
            if (random_.chance(0.5)) command.emplace_back("--json");
        }
        if (program(command).exit_code != 0)
            judge_nothing_left(folder_, outcome_);
        else if (kind == Kind::merge)
            judge_picture(folder_ / "out.exr", false, outcome_);
        return outcome_;
    }

    CaseOutcome environment() {
        const std::string from = random_.pick({"env.exr", "env.exr", "env.hdr", "env.png"});
        const std::string to = "case" + from.substr(3);
        if (from == "env.exr" && random_.chance(0.5))
            write_mutated_picture(at(from), at(to), random_);
        else
            write_bytes(at(to), mutated_bytes(read_bytes(at(from)), random_));
        return render_text(
            fmt::format("[render]\nwidth = 4\nheight = 3\nsamples = 2\nmax_bounces = 20\n[environment]\nfile = \"{}\"\n"
                        "[[material]]\nname = \"m\"\nkind = \"diffuse\"\n[[object]]\nkind = \"sphere\"\nradius_mm = 4.0\n"
                        "material = \"m\"\n",
                        to),
            {}, true);
    }

    CaseOutcome mesh() {
        const std::string from = random_.pick({"cube.obj", "cube.ply", "cube.stl"});
        const std::string to = "case" + from.substr(4);
        const std::string bytes = read_bytes(at(from));
        write_bytes(at(to), random_.chance(0.5) ? mutated_bytes(bytes, random_) : mutated_mesh(bytes));
        if (random_.chance(0.4))
            return build_text(
                fmt::format("[shape]\nkind = \"mesh\"\nfile = \"{}\"\n[grains]\nnum_sites = 10\nresolution = 12\n", to), {});
        std::string scene =
            "[render]\nwidth = 4\nheight = 3\nsamples = 1\nmax_bounces = 20\n[environment]\nkind = \"constant\"\n";
        scene += fmt::format("[[material]]\nname = \"m\"\nkind = \"{}\"\n", random_.pick({"dielectric", "diffuse"}));
        scene += fmt::format("[[object]]\nkind = \"mesh\"\nmaterial = \"m\"\nfile = \"{}\"\n", to);
        if (random_.chance(0.5)) scene += "smooth_normals_deg = 40.0\n";
        return render_text(scene, {}, true);
    }

    /// Another number in place of one of a mesh's.
    std::string mutated_mesh(std::string text) {
        const std::size_t space = text.find(' ', random_.below(text.size()));
        if (space == std::string::npos) return text;
        const std::size_t end = text.find_first_of(" \n", space + 1);
        return text.replace(
            space + 1, end == std::string::npos ? 0 : end - space - 1,
            random_.pick({"nan", "inf", "1e30", "1e-30", "-1", "0", "1", "99999999", "3000000000", "1e7", "x", ""}));
    }

    CaseOutcome table() {
        const std::string from =
            random_.pick({"n.csv", "nk.csv", "light.csv", "absorber.csv", "sites.csv", "weights.csv", "orientations.csv"});
        const std::string bytes = read_bytes(at(from));
        write_bytes(at("case.csv"), random_.chance(0.5) ? mutated_bytes(bytes, random_) : mutated_table(bytes));
        const std::string recipe = "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 12\n";
        if (from == "sites.csv") return build_text(recipe + "sites = { kind = \"file\", file = \"case.csv\" }\n", {});
        if (from == "weights.csv")
            return build_text(
                recipe + "sites = { kind = \"file\", file = \"sites.csv\" }\nweight = { kind = \"csv\", file = \"case.csv\" }\n",
                {});
        if (from == "orientations.csv")
            return build_text(
                recipe +
                    "num_sites = 2\nsintering = { probability = 0.0 }\norientation = { kind = \"table\", file = \"case.csv\" }\n",
                {});
        std::string scene =
            "[render]\nwidth = 4\nheight = 3\nsamples = 1\nmax_bounces = 20\n[environment]\nkind = \"constant\"\n";
        scene += from == "light.csv" ? "illuminant_file = \"case.csv\"\n" : "";
        scene += from == "nk.csv" ? "[[material]]\nname = \"m\"\nkind = \"conductor\"\nmetal = \"case.csv\"\n"
                                  : "[[material]]\nname = \"m\"\nkind = \"dielectric\"\n";
        scene += from == "n.csv" ? "n = \"case.csv\"\n" : "";
        scene += from == "absorber.csv" ? "medium = { absorber = \"case.csv\", sigma_a_per_mm = 1.0 }\n" : "";
        return render_text(scene + "[[object]]\nkind = \"sphere\"\nradius_mm = 4.0\nmaterial = \"m\"\n", {}, true);
    }

    std::string mutated_table(std::string text) {
        const std::size_t comma = text.find_first_of(",\n", random_.below(text.size()));
        if (comma == std::string::npos) return text;
        const std::size_t end = text.find_first_of(",\n", comma + 1);
        return text.replace(comma + 1, end == std::string::npos ? 0 : end - comma - 1,
                            random_.pick({"nan", "inf", "1e300", "1e-300", "-1", "0", "1e10", "x", "", "1e7", "0.000001"}));
    }

    const std::filesystem::path folder_;
    const std::uint64_t seed_, index_;
    CaseRandom random_;
    CaseOutcome outcome_;
};

}  // namespace

const std::vector<std::string>& kind_names() {
    return names;
}

Kind kind_of(Lane lane, std::uint64_t index) {
    if (lane == Lane::scenes) return Kind::scene;
    if (lane == Lane::recipes) return Kind::recipe;
    return turns[index % std::size(turns)];
}

CaseOutcome run_case(const std::filesystem::path& folder, Kind kind, std::uint64_t seed, std::uint64_t index) {
    return Case(folder, seed, index).run(kind);
}

void remove_case_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("case.") || name.starts_with("out.") || name.starts_with(".")) found.push_back(entry.path());
    }
    for (const std::filesystem::path& path : found) std::filesystem::remove_all(path);
}

}  // namespace opal::fuzz
