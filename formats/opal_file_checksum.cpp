// SPDX-License-Identifier: Apache-2.0
#include "formats/opal_file_checksum.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "formats/content_hash.h"
#include "formats/error.h"

namespace opal {
namespace {

/// Behind the magic number (8 bytes), three version numbers (4 each) and a flag (1).
constexpr std::size_t uuid_begin = 21, uuid_length = 36;
constexpr const char* uuid_start = "6f70616c-";

std::string uuid_of(std::uint64_t hash) {
    const std::string digits = fmt::format("{:016x}", hash);
    return fmt::format("{}{}-8{}-8{}-{}000000", uuid_start, digits.substr(0, 4), digits.substr(4, 3), digits.substr(7, 3),
                       digits.substr(10, 6));
}

struct StampedFile {
    std::string uuid;      ///< as it stands in the file; empty where that is too short
    std::string checksum;  ///< the UUID that the rest of the file asks for
};

StampedFile read_stamp(std::istream& stream) {
    StampedFile stamped;
    std::string head(uuid_begin + uuid_length, '\0');
    if (!stream.read(head.data(), std::streamsize(head.size()))) return stamped;
    stamped.uuid = head.substr(uuid_begin);
    ContentHash hash;
    hash.add(head.data(), uuid_begin);
    std::vector<char> buffer(1 << 20);
    while (stream.read(buffer.data(), std::streamsize(buffer.size())), stream.gcount() > 0)
        hash.add(buffer.data(), std::size_t(stream.gcount()));
    stamped.checksum = uuid_of(hash.value());
    return stamped;
}

}  // namespace

void stamp_checksum(const std::filesystem::path& file) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    const StampedFile stamped = read_stamp(stream);
    stream.clear();
    stream.seekp(uuid_begin);
    stream << stamped.checksum;
    stream.close();
    if (!stream || stamped.uuid.empty())
        throw SystemError(fmt::format("{}: writing failed: {}", file.string(), std::strerror(errno)));
}

Checksum look_at_checksum(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string head(uuid_begin + uuid_length, '\0');
    stream.read(head.data(), std::streamsize(head.size()));
    if (!stream || head.compare(uuid_begin, std::strlen(uuid_start), uuid_start) != 0) return Checksum::none;
    stream.seekg(0);
    const StampedFile stamped = read_stamp(stream);
    return stamped.uuid == stamped.checksum ? Checksum::fits : Checksum::differs;
}

}  // namespace opal
