// SPDX-License-Identifier: Apache-2.0
#include "formats/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

#include "formats/error.h"

namespace opal {
namespace {

bool is_ply(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension == ".ply";
}

}  // namespace

void require_sound_ply_header(const std::filesystem::path& file) {
    if (!is_ply(file)) return;
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    std::ifstream stream(file, std::ios::binary);
    std::string line;
    while (std::getline(stream, line)) {
        std::istringstream words(line);
        std::string first, name, count;
        words >> first >> name >> count;
        if (first == "end_header") return;
        if (first != "element") continue;
        // Each element takes at least a byte.
        const bool is_count = std::isalpha(static_cast<unsigned char>(name[0])) && !count.empty() && count.size() < 19 &&
                              std::all_of(count.begin(), count.end(), [](unsigned char c) { return std::isdigit(c); });
        if (!is_count || std::stoull(count) > bytes)
            throw InputError(fmt::format("{}: damaged: its header states '{}' elements '{}', the file has {} bytes",
                                         file.string(), count, name, bytes));
    }
    throw InputError(fmt::format("{}: not a readable mesh: its header does not end (no line end_header)", file.string()));
}

}  // namespace opal
