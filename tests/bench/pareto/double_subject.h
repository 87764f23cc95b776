// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drawings.h"

namespace opal {

/// One scene with some settings, drawn in double precision: by opal-draw-double, a program of its own, as the transport's
/// arithmetic is chosen when it is compiled.
class DoubleSubject : public Drawings {
  public:
    /// `folder`: for files on the way.
    DoubleSubject(std::filesystem::path scene, std::vector<std::string> settings, std::filesystem::path folder);

    void draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed,
              Lighting lighting = Lighting::of_the_scene) override;
    std::size_t memory_bytes() const override { return memory_bytes_; }
    double load_s() const override { return load_s_; }

  private:
    const std::filesystem::path scene_;
    const std::vector<std::string> settings_;
    const std::filesystem::path folder_;
    std::size_t memory_bytes_ = 0;
    double load_s_ = 0.0;
};

}  // namespace opal
