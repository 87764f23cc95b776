// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "renderer/host/path_device.h"

namespace opal {

/// Several devices as one: each draws a share of the samples of every launch, all at once; the shares are added to the film in
/// the order of the devices, so that the result does not depend on which ends first. Against one device alone, sums are rounded
/// otherwise, by where launches are cut.
class SeveralDevices : public PathDevice {
  public:
    /// At least one.
    explicit SeveralDevices(std::vector<std::unique_ptr<PathDevice>> devices) : devices_(std::move(devices)) {}

    std::vector<std::string> names() const override;
    /// Of all of them together; nothing where one of them has no clock.
    std::optional<KernelSeconds> kernel_seconds() const override;
    /// Throws what the first of the devices that failed threw.
    void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) override;

  private:
    void advance_in_group(Film& film, std::span<const int> blocks, std::uint32_t first, std::uint32_t samples);

    std::vector<std::unique_ptr<PathDevice>> devices_;
    std::vector<std::unique_ptr<Film>> shares_;  ///< of each device, empty between launches
};

}  // namespace opal
