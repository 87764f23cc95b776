// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/image.h"

namespace opal {

/// How often the difference of two pictures exceeds its standard error: z = (a - b) / sqrt(variance a + variance b) over the
/// pixels' R, G and B that have any variance. Of two correct renders of one scene from independent random numbers, with many
/// samples, 4.55 %, 0.27 % and 0.0063 % lie beyond 2, 3 and 4 (fewer where samples are stratified: the variance is stated as if
/// they were not).
struct NoiseTest {
    double beyond_2_sigma = 0.0, beyond_3_sigma = 0.0, beyond_4_sigma = 0.0;  ///< fractions
    double mean_z[3] = {};  ///< z of the whole picture's mean R, G, B: finds a small bias that no pixel shows
};

/// How a picture differs from a reference.
struct ImageComparison {
    /// Mean over pixels and R, G, B of (a - b)^2 / (b^2 + 0.01 m^2), m the mean of the reference's R, G and B: the relative
    /// squared error of Rousselle et al. 2011 with a floor that scales with the picture.
    double relative_mse = 0.0;
    double psnr_db = 0.0;                 ///< of the tone-mapped pictures, peak 1; infinite where they are equal
    double mean_ratio[3] = {};            ///< mean of a over mean of b: R, G, B
    double delta_e_mean = 0.0;            ///< CIEDE2000 of the tone-mapped pictures
    double delta_e_95 = 0.0;              ///< its 95th percentile over pixels
    std::optional<NoiseTest> noise_test;  ///< where both hold variances
    Image difference;                     ///< a - b in R, G, B, and delta_e
};

/// Compares two linear pictures, shown at the given exposure. Throws InputError where they have no R, G, B, differ in size, or
/// hold values that are not finite; the names stand for them in messages.
ImageComparison compare_images(const Image& picture, const Image& reference, double exposure_ev,
                               const std::string& picture_name = "the picture",
                               const std::string& reference_name = "the reference");

}  // namespace opal
