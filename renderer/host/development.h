// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/image.h"
#include "formats/scene.h"

/// From a linear picture to the one that people look at.
namespace opal {

/// Header attribute of an EXR that holds its [film] section, by which `opal-render develop` knows what white its RGB is adapted
/// from and how its own PNG was made.
inline constexpr const char* film_attribute = "opal:film";

/// The film settings in a picture's header, or the defaults where there are none. `file` stands for it in messages.
FilmDescription film_of_image(const Image& image, const std::string& file);

/// Linear sRGB of a picture whose neutral was `taken`'s white, with `shown`'s white neutral instead: back to XYZ as the scene had
/// it, then Bradford's adaptation from the new white to D65. The same white leaves every bit as it is.
Image white_balanced(Image linear, const FilmDescription& taken, const FilmDescription& shown);

/// The display picture: white balance, exposure, tone curve. Throws InputError where the picture has no R, G, B.
Image developed(const Image& linear, const FilmDescription& taken, const FilmDescription& shown, const std::string& file);

/// The part of a picture within a window that is given in pixels of the whole picture. Throws InputError where the window does
/// not lie within what the image holds; `where` names the flag.
Image cropped(const Image& image, const PixelWindow& window, const std::string& where);

}  // namespace opal
