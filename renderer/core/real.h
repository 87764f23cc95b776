// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/compat.h"

namespace opal {

/// What the transport computes in: single precision, which is enough (docs/speed-and-accuracy.md). With OPAL_DOUBLE_TRANSPORT
/// double, to measure that. Data that come from files and tables are single in both.
#if defined(OPAL_DOUBLE_TRANSPORT)
using real = double;
#else
using real = float;
#endif

}  // namespace opal
