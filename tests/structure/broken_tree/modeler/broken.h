// SPDX-License-Identifier: Apache-2.0
// Breaks a rule on purpose: the test of the include rules must reject this tree.
#include "renderer/core/vec.h"
