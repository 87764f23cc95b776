// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/image.h"
#include "modeler/section_raster.h"

namespace opal {

struct SectionRequest {
    int axis = 2;                 ///< the sections' normal: 0 x, 1 y, 2 z
    std::optional<double> at_mm;  ///< where along it; left out: the middle of the opal, or `slices` sections spread evenly
    int slices = 1;
    SectionColor color = SectionColor::grain;
    int size_px = 800;  ///< the longer side of one section
};

/// An opal to cut and what its sections are called: the file's name for errors, a short title for a picture of several opals.
struct SectionSubject {
    const OpalAsset* asset;
    std::string file;
    std::string title;
};

/// Draws one section, or a sheet of all the sections of all the opals in one scale: coloured inside the outline, with grain
/// boundaries, a scale bar, axes in mm where there is one section, a colour bar or the key of the orientations where the
/// colouring has one. Orientations are shown by the lattice direction that lies along the axis (cubic_direction_color); fields
/// by viridis between their extremes over all the sections. The same input gives the same picture. Throws InputError where the
/// place lies outside of an opal or a field is not in its file.
Image draw_sections(const std::vector<SectionSubject>& subjects, const SectionRequest& request);

}  // namespace opal
