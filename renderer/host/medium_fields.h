// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal_asset.h"
#include "formats/scene.h"
#include "renderer/core/medium.h"
#include "renderer/host/field_grid.h"
#include "renderer/host/majorant_grid.h"

namespace opal {

/// The coefficients of an opal's body from place to place: those that vary as fields with their majorants, the others as one
/// value. A field that is the same everywhere in the opal (0, say) is dropped for that value.
class MediumFields {
  public:
    /// `scale`: world mm per object mm. Throws InputError (check_majorants). `file`: for messages.
    MediumFields(const OpalAsset& asset, MajorantKind majorants, double scale, const std::string& file,
                 TrackingKind tracking = TrackingKind::residual);

    /// What stands in the medium's tables for each field: its value where it does not vary, else 1.
    double constant(MediumField field) const { return constants_[std::size_t(field)]; }
    bool varies(MediumField field) const { return grids_[std::size_t(field)] != nullptr; }
    /// Puts the fields that vary into the view; valid while this object lives.
    void attach(MediumView& view) const;
    /// Null where nothing varies.
    const MajorantGrid* majorants() const { return majorants_.get(); }

  private:
    std::array<double, num_medium_fields> constants_;
    MediumFieldGrids grids_;
    std::vector<FieldGridData> data_;
    std::array<FieldView, num_medium_fields> views_;
    std::unique_ptr<MajorantGrid> majorants_;
};

}  // namespace opal
