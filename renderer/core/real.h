// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/compat.h"

namespace opal {

/// What the transport computes in: single precision, which is enough (docs/speed-and-accuracy.md). With OPAL_DOUBLE_TRANSPORT
/// double, to measure that: the arithmetic alone. What the host hands over (sites, tables, planes, the camera) and random numbers
/// are of single precision in both, and so are the distances that single precision asks to be kept, as from a surface just left.
#if defined(OPAL_DOUBLE_TRANSPORT)
using real = double;
#else
using real = float;
#endif

}  // namespace opal
