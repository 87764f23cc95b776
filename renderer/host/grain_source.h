// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/opal_asset.h"
#include "formats/scene.h"
#include "renderer/core/grain_path.h"
#include "renderer/host/cell_data.h"
#include "renderer/host/grain_grid.h"

namespace opal {

/// Where the transport learns of the grains of an opal: its voxels, or the cells of its sites.
class GrainSource {
  public:
    /// Takes cells where they are asked for or, with `automatic`, where the file's sites describe the grains exactly; else
    /// voxels: so where another program has changed the labels, which is told in `notices`. `file` is named in these and in
    /// errors. Throws InputError where what is asked for cannot be had from the file, saying why.
    GrainSource(const OpalAsset& asset, GrainsKind asked, const std::string& file, std::vector<std::string>& notices);

    GrainsView view() const;
    /// As in scenes: cells, voxels, sphere-tracing, hyperboloid.
    const char* method_name() const;
    /// Memory of what is walked.
    std::size_t size_bytes() const;
    /// Diameter (mm) of a ball as large as each grain; element g - 1 is grain g's.
    const std::vector<float>& sizes_mm() const { return sizes_mm_; }

  private:
    GrainMethod method_ = GrainMethod::voxels;
    std::unique_ptr<GrainGridData> voxels_;
    std::unique_ptr<CellData> cells_;
    std::vector<float> sizes_mm_;
};

}  // namespace opal
