// SPDX-License-Identifier: Apache-2.0
#include "formats/report.h"

#include <fmt/format.h>
#include <openvdb/version.h>
#include <sys/resource.h>
#include <tbb/version.h>

#include "formats/atomic_file.h"
#include "formats_generated/version.h"

namespace opal {

std::uint64_t peak_memory_bytes() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024u;
}

nlohmann::json version_report(const nlohmann::json& more) {
    nlohmann::json versions = {{"opal", OPAL_VERSION_STRING},
                               {"openvdb", OPENVDB_LIBRARY_VERSION_STRING},
                               {"tbb", fmt::format("{}.{}", TBB_VERSION_MAJOR, TBB_VERSION_MINOR)},
                               {"compiler", __VERSION__}};
    versions.update(more);
    return versions;
}

void write_report(const std::filesystem::path& path, const nlohmann::json& report) {
    write_text_file(path, report.dump(2) + "\n");
}

}  // namespace opal
