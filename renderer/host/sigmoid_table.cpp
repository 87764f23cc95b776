// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/sigmoid_table.h"

#include <algorithm>
#include <cmath>

// The assembler takes in the computed file as it is: compiling 300,000 numbers would take longer than computing them.
asm(R"(
.pushsection .rodata
.balign 64
.global opal_sigmoid_table
.type opal_sigmoid_table, %object
opal_sigmoid_table:
.incbin ")" OPAL_SIGMOID_TABLE_FILE R"("
.size opal_sigmoid_table, . - opal_sigmoid_table
.popsection
)");

extern "C" const float opal_sigmoid_table[];

namespace opal {

double sigmoid_table_coordinate(double lightness) {
    return (lightness - 0.5) / std::sqrt(std::clamp(lightness * (1.0 - lightness), 1.0e-5, 1.0));
}

std::span<const float, sigmoid_table_floats> sigmoid_table() {
    return std::span<const float, sigmoid_table_floats>(opal_sigmoid_table, std::size_t(sigmoid_table_floats));
}

}  // namespace opal
