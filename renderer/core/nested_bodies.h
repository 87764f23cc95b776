// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/compat.h"

namespace opal {

/// One bit per transparent body of a scene.
inline constexpr int max_bodies = 64;

/// In which transparent bodies a place lies. Bodies may overlap: their numbers are in the order of their priorities, and the one
/// of the highest number is what is there (Schmidt & Budge 2002, "Simple nested dielectrics in ray traced images"). A set, not a
/// stack: a surface passed without notice (a gap between triangles) is made good by the next one of the same body.
struct NestedBodies {
    uint64_t inside = 0;

    /// The body that is here; -1 in the open.
    OPAL_HD int current() const {
        int body = -1;
        for (uint64_t rest = inside; rest != 0; rest >>= 1) ++body;
        return body;
    }
    OPAL_HD NestedBodies entered(int body) const { return {inside | (uint64_t(1) << body)}; }
    OPAL_HD NestedBodies left(int body) const { return {inside & ~(uint64_t(1) << body)}; }
};

}  // namespace opal
