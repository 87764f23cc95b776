// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "variants.h"

namespace opal {

/// An opal as opal-model built it for a bench.
struct OpalBuild {
    std::filesystem::path file;
    std::uintmax_t bytes = 0;
    double processor_s = 0.0;
};

/// The scene with its files as they are called from the project's folder.
ParetoScene in_project(const ParetoScene& scene);

/// Builds opals with the program itself, each once; removes them in the end.
class OpalBuilds {
  public:
    explicit OpalBuilds(std::filesystem::path folder);
    ~OpalBuilds();
    OpalBuilds(const OpalBuilds&) = delete;
    OpalBuilds& operator=(const OpalBuilds&) = delete;

    /// The opal of a variant. Throws SystemError with the command where it fails.
    const OpalBuild& build(const ParetoScene& scene, const ParetoVariant& variant);

    const std::filesystem::path& folder() const { return folder_; }

    /// What builds it, for people.
    static std::string command(const ParetoScene& scene, const ParetoVariant& variant);

  private:
    std::filesystem::path folder_;
    std::map<std::string, OpalBuild> built_;  ///< by command
};

}  // namespace opal
