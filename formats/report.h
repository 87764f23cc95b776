// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace opal {

/// Largest resident set of this process so far, in bytes.
std::uint64_t peak_memory_bytes();

/// Program version and the versions of the libraries that decide results; `more` names those that this room does not know.
nlohmann::json version_report(const nlohmann::json& more = nlohmann::json::object());

/// Writes a JSON report atomically.
void write_report(const std::filesystem::path& path, const nlohmann::json& report);

}  // namespace opal
