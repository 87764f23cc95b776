// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "modeler/shape.h"

namespace opal {

/// The solid bounded by the recipe's Bezier patches. Its distance is that of their triangles, which lie within
/// `chord_error_mm` (0: a thousandth of the longest side) of the patches. Throws InputError for a chord error that takes too many
/// triangles or leaves no solid.
std::unique_ptr<Shape> make_bezier_shape(const ShapeRecipe& recipe);

}  // namespace opal
