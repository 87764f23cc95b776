// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "case_random.h"

namespace opal::fuzz {

/// A text of keys and values with one to three things wrong: values put to extremes or of other types, lines lost, doubled or
/// exchanged, a stretch of `other` put in, bytes flipped.
std::string mutated_text(const std::string& text, const std::string& other, CaseRandom& random);

/// Bytes with one thing wrong, more often near the beginning: flipped bits, bytes overwritten by extremes, a stretch doubled or
/// lost, an early end.
std::string mutated_bytes(std::string bytes, CaseRandom& random);

/// Reads a picture and writes it with values, channels, header or size that no renderer leaves.
void write_mutated_picture(const std::filesystem::path& from, const std::filesystem::path& to, CaseRandom& random);

/// Reads a .vdb and writes it with values, metadata, names or transforms that no modeler leaves.
void write_mutated_grids(const std::filesystem::path& from, const std::filesystem::path& to, CaseRandom& random);

}  // namespace opal::fuzz
