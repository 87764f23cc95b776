// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/colorimetry.h"
#include "renderer/core/spectrum_view.h"

namespace opal {

/// How a picture's spectrum is sampled: by wavelengths drawn from a density, or at a few fixed ones.
enum class SpectralChoice {
    continuous,
    bins_10nm,  ///< one of 48 wavelengths, 10 nm apart, all as likely
    rgb         ///< three wavelengths, each the whole of one component of linear sRGB
};

/// Fixed wavelengths in place of a continuous spectrum, without another transport: the density of drawn wavelengths is confined
/// to lines 2 nm wide (1 nm at the ends of the range), and each line counts with the colour of all that it stands for.
class SpectralLines {
  public:
    SpectralLines(const SpectrumTables& tables, SpectralChoice choice);

    /// Makes paths draw these wavelengths. The tables then point into this object.
    void confine(SpectrumTables& tables) const;
    /// Colour of a spectral radiance of 1 at a drawn wavelength, over the wavelength's density (1/nm): an estimate of its share
    /// in the picture's colour.
    Xyz color(const SpectrumTables& tables, real wavelength_nm, real pdf_per_nm) const;

  private:
    struct Line {
        int first_nm = 0, width_nm = 0;  ///< from the start of the range
        Xyz color;
    };
    void add_line(int centre_nm, Xyz color);

    SpectralChoice choice_;
    std::vector<Line> lines_;
    std::vector<int> line_of_nm_;  ///< of each nanometre; -1: none
    std::vector<float> pdf_, cdf_;
};

}  // namespace opal
