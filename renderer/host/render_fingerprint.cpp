// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/render_fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "formats/error.h"
#include "formats_generated/version.h"
#include "formats/content_hash.h"

namespace opal {
namespace {

/// Keys that may change while a render goes on.
constexpr const char* free_keys[] = {"render.samples", "film.exposure_ev", "film.tone", "film.aovs"};

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    ContentHash hash;
    std::vector<char> buffer(1 << 20);
    while (file.read(buffer.data(), std::streamsize(buffer.size())), file.gcount() > 0)
        hash.add(buffer.data(), std::size_t(file.gcount()));
    if (file.bad()) throw InputError(fmt::format("{}: cannot be read", path.string()));
    return fmt::format("content {:016x}", hash.value());
}

/// A value of the resolved scene; what names a file becomes the file's content.
std::string comparable(const std::string& value) {
    if (value.size() < 3 || value.front() != '"' || value.back() != '"') return value;
    std::string text;
    for (std::size_t i = 1; i + 1 < value.size(); ++i) {
        if (value[i] == '\\') ++i;
        text += value[i];
    }
    std::error_code ignored;
    return std::filesystem::is_regular_file(text, ignored) ? content_of(text) : value;
}

std::vector<std::pair<std::string, std::string>> entries_of(const std::string& fingerprint) {
    std::vector<std::pair<std::string, std::string>> entries;
    std::istringstream lines(fingerprint);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find(" = ");
        if (equals == std::string::npos)
            entries.emplace_back(line, "");
        else
            entries.emplace_back(line.substr(0, equals), line.substr(equals + 3));
    }
    return entries;
}

}  // namespace

std::string render_fingerprint(const SceneDescription& scene) {
    std::string fingerprint = fmt::format("program = opal-render {}\n", OPAL_VERSION_STRING);
    std::istringstream lines(scene_to_toml(scene));
    std::string section;
    std::map<std::string, int> repeated;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) continue;
        if (line.starts_with("[[")) {
            const std::string name = line.substr(2, line.size() - 4);
            section = fmt::format("{}.{}", name, repeated[name]++);
        } else if (line.front() == '[' && line.find('=') == std::string::npos) {
            section = line.substr(1, line.size() - 2);
        } else {
            const std::size_t equals = line.find(" = ");
            const std::string key = section + "." + line.substr(0, equals);
            if (std::find(std::begin(free_keys), std::end(free_keys), key) != std::end(free_keys)) continue;
            const std::string value = equals == std::string::npos ? "" : comparable(line.substr(equals + 3));
            fingerprint += fmt::format("{} = {}\n", key, value);
        }
    }
    return fingerprint;
}

std::string fingerprint_difference(const std::string& first_fingerprint, const std::string& first,
                                   const std::string& second_fingerprint, const std::string& second) {
    if (first_fingerprint == second_fingerprint) return "";
    const auto a = entries_of(first_fingerprint), b = entries_of(second_fingerprint);
    for (const auto& [key, value] : a) {
        const auto other = std::find_if(b.begin(), b.end(), [&](const auto& entry) { return entry.first == key; });
        if (other == b.end()) return fmt::format("{} is {} in {} and absent in {}", key, value, first, second);
        if (other->second != value) return fmt::format("{} is {} in {} and {} in {}", key, value, first, other->second, second);
    }
    for (const auto& [key, value] : b)
        if (std::none_of(a.begin(), a.end(), [&](const auto& entry) { return entry.first == key; }))
            return fmt::format("{} is absent in {} and {} in {}", key, first, value, second);
    return fmt::format("the order of the scene's keys is another in {} than in {}", first, second);
}

}  // namespace opal
