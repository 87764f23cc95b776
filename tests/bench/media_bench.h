// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace opal {

/// One way of following flights through one medium.
struct MediaBenchRow {
    std::string medium;     ///< absorption; or body: absorption and scattering
    std::string field;      ///< waves, layers, clouds
    double contrast = 0.0;  ///< the field is the coefficient times 1 +- contrast
    std::string method;     ///< residual; or ratio: minima taken as 0
    int cells = 1;          ///< of the majorant grid along the longest side
    bool fitted = false;    ///< as MajorantGrid::fitted chooses
    double ns_per_flight = 0.0;
    double variance = 0.0;  ///< of one flight's estimate of the transmittance, for a given ray
};

/// Cost and variance of local against global majorants and of residual against plain ratio tracking, over the contrast of the
/// field: chords of a ball 6 mm across, 4 wavelengths per path, mean extinction 0.5 to 1 per mm. One thread; about a minute.
std::vector<MediaBenchRow> bench_media();

}  // namespace opal
