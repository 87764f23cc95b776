// SPDX-License-Identifier: GPL-3.0-or-later
#include "double_subject.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

#include "formats/error.h"
#include "shell_word.h"

namespace opal {

DoubleSubject::DoubleSubject(std::filesystem::path scene, std::vector<std::string> settings, std::filesystem::path folder)
    : scene_(std::move(scene)), settings_(std::move(settings)), folder_(std::filesystem::absolute(folder)) {}

void DoubleSubject::draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed, Lighting lighting) {
    const std::filesystem::path list = folder_ / "double_pixels.txt", drawn = folder_ / "double_drawn.txt";
    std::ofstream asked(list);
    for (const std::uint32_t pixel : pixels) asked << pixel << '\n';
    asked.close();
    if (!asked) throw SystemError(fmt::format("{}: writing failed", list.string()));
    std::string command =
        fmt::format("{} {} --pixels {} -o {} --samples {} --seed {}", shell_word(OPAL_DRAW_DOUBLE), shell_word(scene_.string()),
                    shell_word(list.string()), shell_word(drawn.string()), samples, seed);
    if (lighting == Lighting::tent) command += " --tent";
    for (const std::string& setting : settings_) command += " --set " + shell_word(setting);
    if (std::system(command.c_str()) != 0) throw SystemError("failed: " + command);
    std::ifstream answer(drawn);
    double sample_s = 0.0;
    answer >> memory_bytes_ >> load_s_ >> sample_s;
    std::vector<Opponent> picture(pixels.size());
    for (Opponent& color : picture) answer >> color[0] >> color[1] >> color[2];
    if (!answer) throw SystemError("no picture came of: " + command);
    keep(std::move(picture), sample_s, lighting);
}

}  // namespace opal
