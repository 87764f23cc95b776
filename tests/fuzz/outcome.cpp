// SPDX-License-Identifier: GPL-3.0-or-later
#include "outcome.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/image.h"
#include "seed_files.h"

namespace opal::fuzz {
namespace {

void add_defect(CaseOutcome& outcome, const std::string& defect) {
    if (!outcome.defect.empty()) outcome.defect += "; ";
    outcome.defect += defect;
}

/// What only the programmer understands.
bool is_raw(const std::string& message) {
    for (const char* raw :
         {"std::", "bad_alloc", "basic_string", "vector::", "map::at", "json.exception", "bad optional", "stoi", "stod"})
        if (message.find(raw) != std::string::npos) return true;
    return false;
}

bool may_be_negative(const std::string& channel) {
    for (const char* name : {"variance", "sample_count", "S0.", "depth"})
        if (channel.starts_with(name)) return false;
    return true;
}

void judge_statistics(const std::filesystem::path& file, CaseOutcome& outcome) {
    const nlohmann::json report = nlohmann::json::parse(read_bytes(file), nullptr, false);
    if (!report.is_object() || !report.contains("counts")) return add_defect(outcome, "statistics without counts");
    const nlohmann::json& counts = report["counts"];
    for (const char* name : {"not_a_number", "majorant_violations"})
        if (counts[name] != 0) add_defect(outcome, fmt::format("{} {}", name, counts[name].dump()));
    outcome.lost_paths += counts["lost_paths"].get<double>();
    outcome.paths += counts["samples"].get<double>();
}

}  // namespace

void judge_run(const ProgramRun& run, bool may_refuse, CaseOutcome& outcome) {
    if (run.exit_code == 0) return;
    std::string error;
    int errors = 0;
    std::istringstream lines(run.text);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("opal-render: error: ") || line.starts_with("opal-model: error: ")) {
            error = line;
            ++errors;
        }
    outcome.refused = true;
    if (run.exit_code != 2 || !may_refuse)
        add_defect(outcome, fmt::format("exit code {}: {}", run.exit_code, error.empty() ? run.text : error));
    else if (errors != 1)
        add_defect(outcome, fmt::format("{} lines of error: {}", errors, run.text));
    else if (is_raw(error))
        add_defect(outcome, "not in words of ours: " + error);
}

void judge_picture(const std::filesystem::path& file, bool made_here, CaseOutcome& outcome) {
    const Image image = read_image(file);
    const std::size_t channels = image.channel_names.size();
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float value = image.pixels[i];
        const std::string& channel = image.channel_names[i % channels];
        if (std::isfinite(value) && (value >= 0.0f || !made_here || may_be_negative(channel))) continue;
        const std::size_t pixel = i / channels, width = std::size_t(image.width);
        return add_defect(outcome, fmt::format("{} of pixel ({}, {}) is {}", channel, pixel % width, pixel / width, value));
    }
}

void judge_rendered(const std::filesystem::path& folder, CaseOutcome& outcome) {
    int pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("out.")) continue;
        if (entry.path().extension() == ".json") judge_statistics(entry.path(), outcome);
        if (entry.path().extension() != ".exr") continue;
        judge_picture(entry.path(), true, outcome);
        ++pictures;
    }
    if (pictures == 0) add_defect(outcome, "no picture");
    if (!std::filesystem::exists(folder / "out.png") && !std::filesystem::exists(folder / "out.sheet.png"))
        add_defect(outcome, "no PNG");
}

void judge_nothing_left(const std::filesystem::path& folder, CaseOutcome& outcome) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if ((name.starts_with("out.") && name != "out.checkpoint") || name.starts_with("."))
            add_defect(outcome, "left behind: " + name);
    }
}

}  // namespace opal::fuzz
