// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

namespace opal {

/// A direction drawn by the way a surface scatters.
template <int N>
struct BsdfSample {
    Vec3 direction;   ///< unit; zero: the path ends here
    Lanes<N> weight;  ///< f |cos| over the lane's own density
    Lanes<N> ratio;   ///< the lane's own density over the hero's
    real pdf = 0.0f;  ///< hero's density, 1/sr; 0: one of finitely many directions
    bool transmitted = false;
};

/// What a surface sends from the path's side into a given direction.
template <int N>
struct BsdfValue {
    Lanes<N> f_cosine;  ///< f |cos|, 1/sr
    real pdf = 0.0f;    ///< density with which the direction is drawn for the hero, 1/sr
};

}  // namespace opal
