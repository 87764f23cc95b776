// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

/// A .vdb carries a UUID in its header, which clients take for an opaque name. In files of opal-model it is a version 8 UUID (RFC
/// 9562) that begins with the letters "opal" and holds a hash of the rest of the file: the same content has the same bytes, and
/// damage is noticed before OpenVDB, which trusts what it reads, meets it. Programs that write the file anew give it another
/// UUID.
namespace opal {

/// Puts the checksum of a finished file into it. Throws SystemError where the file cannot be read or written.
void stamp_checksum(const std::filesystem::path& file);

enum class Checksum { none, fits, differs };

/// Of a file: `none` where another program wrote it; `differs` where it is damaged or cut off.
Checksum look_at_checksum(const std::filesystem::path& file);

}  // namespace opal
