// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/host/film.h"

namespace opal {

/// The means R, G, B as far as they have come, while others render: block by block, each between two of its passes.
Image film_preview(const Film& film);

}  // namespace opal
