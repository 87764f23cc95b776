// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "renderer/host/film.h"

/// The exact state of a render in a file, so that it can be continued with the same result to the bit.
///
/// Little-endian: the 8 bytes "OPALCKPT"; format version (32 bits); length (32 bits) and text of a JSON header (fingerprint,
/// window, layout, seconds spent); a 64-bit hash of all so far; per block of the film, in order: samples done (32 bits), settled
/// (32 bits), noise in luminance and chroma (32-bit floats), counters, totals, and per pixel its sums (64-bit floats) and sample
/// count (32 bits); the noise's floor (64-bit float); a 64-bit hash of all before it.
namespace opal {

struct CheckpointHeader {
    std::string fingerprint;  ///< of render_fingerprint
    double render_s = 0.0;    ///< time spent rendering so far
};

/// Writes a film's state atomically, while others render it: each block is locked only while it is copied. Throws InputError or
/// SystemError; an earlier file is then as it was.
void write_checkpoint(const std::filesystem::path& path, const Film& film, const CheckpointHeader& header);

/// The header alone. Throws InputError where the file is no checkpoint of this version.
CheckpointHeader read_checkpoint_header(const std::filesystem::path& path);

/// Fills a film of the same window and layout with a checkpoint's state. Throws InputError where the file is damaged or the film
/// another; the film is then of no use.
void read_checkpoint(const std::filesystem::path& path, Film& film);

}  // namespace opal
