// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/image.h"

namespace opal {

/// Small pictures side by side with a label under each: a film at a glance.
class ContactSheet {
  public:
    /// For `count` pictures of the given size; each is shown at most `tile_px` wide and high.
    ContactSheet(int count, int picture_width, int picture_height, int tile_px = 240);

    /// Adds a display picture (three channels in [0, 1]), averaged over areas. Throws std::out_of_range beyond `count`.
    void add(const Image& display, const std::string& label);

    const Image& image() const { return sheet_; }

  private:
    int columns_, tile_width_, tile_height_;
    int count_, used_ = 0;
    Image sheet_;
};

}  // namespace opal
