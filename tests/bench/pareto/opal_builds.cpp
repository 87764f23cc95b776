// SPDX-License-Identifier: GPL-3.0-or-later
#include "opal_builds.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdlib>

#include "formats/error.h"
#include "shell_word.h"

namespace opal {
namespace {

double children_processor_s() {
    rusage usage = {};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string build_command(const std::string& program, const ParetoScene& scene, const ParetoVariant& variant,
                          const std::string& output) {
    std::string text = fmt::format("{} build {} -o {}", program, shell_word(scene.recipe.string()), shell_word(output));
    for (const std::string& assignment : variant.recipe) text += " --set " + shell_word(assignment);
    if (!variant.for_pixels.empty())
        text += fmt::format(" --for {} --for-pixels {}", shell_word(scene.scene.string()), variant.for_pixels);
    return text;
}

}  // namespace

ParetoScene in_project(const ParetoScene& scene) {
    const std::filesystem::path root = std::filesystem::path(OPAL_EXAMPLES).parent_path();
    ParetoScene relative = scene;
    relative.recipe = scene.recipe.lexically_proximate(root);
    relative.scene = scene.scene.lexically_proximate(root);
    return relative;
}

OpalBuilds::OpalBuilds(std::filesystem::path folder) : folder_(std::filesystem::absolute(folder)) {
    std::filesystem::create_directories(folder_);
}

OpalBuilds::~OpalBuilds() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::string OpalBuilds::command(const ParetoScene& scene, const ParetoVariant& variant) {
    return build_command("opal-model", in_project(scene), variant, scene.name + ".vdb");
}

const OpalBuild& OpalBuilds::build(const ParetoScene& scene, const ParetoVariant& variant) {
    const std::string known_as = command(scene, variant);
    if (const auto found = built_.find(known_as); found != built_.end()) return found->second;
    OpalBuild result;
    result.file = folder_ / fmt::format("{}_{}.vdb", scene.name, built_.size());
    const std::string command = build_command(OPAL_MODEL, scene, variant, result.file.string());
    const double before_s = children_processor_s();
    if (std::system((command + " > /dev/null").c_str()) != 0) throw SystemError("failed: " + command);
    result.processor_s = children_processor_s() - before_s;
    result.bytes = std::filesystem::file_size(result.file);
    return built_.emplace(known_as, result).first->second;
}

}  // namespace opal
