// SPDX-License-Identifier: Apache-2.0
#include "formats/image_text.h"

#include <ft2build.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>
#include FT_FREETYPE_H

namespace opal {
namespace {

std::filesystem::path find_font(const std::string& name) {
    for (const char* folder : {"/usr/share/fonts", "/usr/local/share/fonts"}) {
        std::error_code error;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error))
            if (entry.path().stem() == name && entry.path().extension() == ".ttf") return entry.path();
    }
    return {};
}

/// A font at one size; `face` is null where it cannot be found.
class Font {
  public:
    explicit Font(const TextStyle& style) {
        const std::filesystem::path file = find_font(style.font);
        if (file.empty() || FT_Init_FreeType(&library_) != 0) return;
        if (FT_New_Face(library_, file.c_str(), 0, &face_) != 0) face_ = nullptr;
        if (face_) FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(style.height_px));
    }
    ~Font() {
        if (face_) FT_Done_Face(face_);
        if (library_) FT_Done_FreeType(library_);
    }
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    bool found() const { return face_ != nullptr; }
    /// The character as grey levels, until the next one is asked for; null where the font lacks it.
    FT_GlyphSlot glyph(char32_t character) const {
        return FT_Load_Char(face_, character, FT_LOAD_RENDER) == 0 ? face_->glyph : nullptr;
    }

  private:
    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
};

/// UTF-8; bytes that belong to no character are left out.
std::vector<char32_t> characters(std::string_view text) {
    std::vector<char32_t> list;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<std::uint8_t>(text[i++]);
        const int following = lead < 0x80 ? 0 : lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : -1;
        if (following < 0) continue;
        char32_t character = following == 0 ? lead : lead & (0x3Fu >> following);
        for (int n = 0; n < following && i < text.size(); ++n) character = (character << 6) | (std::uint8_t(text[i++]) & 0x3Fu);
        list.push_back(character);
    }
    return list;
}

int width_px(const Font& font, const std::vector<char32_t>& text) {
    FT_Pos width = 0;
    for (const char32_t character : text)
        if (const FT_GlyphSlot glyph = font.glyph(character)) width += glyph->advance.x;
    return static_cast<int>(width >> 6);
}

void blend(Image& image, int left, int top, const FT_Bitmap& bitmap, const std::array<float, 3>& color) {
    for (int row = std::max(0, -top); row < int(bitmap.rows) && top + row < image.height; ++row)
        for (int column = std::max(0, -left); column < int(bitmap.width) && left + column < image.width; ++column) {
            const float cover = float(bitmap.buffer[row * bitmap.pitch + column]) / 255.0f;
            float* const pixel = image.pixel(left + column, top + row);
            for (int c = 0; c < 3; ++c) pixel[c] += cover * (color[std::size_t(c)] - pixel[c]);
        }
}

}  // namespace

int text_width_px(const std::string& text, const TextStyle& style) {
    const Font font(style);
    return font.found() ? width_px(font, characters(text)) : 0;
}

bool draw_text(Image& image, int x, int y, const std::string& text, const TextStyle& style) {
    const Font font(style);
    if (!font.found()) return false;
    const std::vector<char32_t> line = characters(text);
    const int width = width_px(font, line);
    if (style.align == TextAlign::center) x -= width / 2;
    if (style.align == TextAlign::right) x -= width;
    // The middle of a capital letter, so that lines with and without descenders stand on one baseline.
    const int baseline = y + (style.height_px * 36 + 50) / 100;
    FT_Pos pen = FT_Pos(x) << 6;
    for (const char32_t character : line)
        if (const FT_GlyphSlot glyph = font.glyph(character)) {
            blend(image, int(pen >> 6) + glyph->bitmap_left, baseline - glyph->bitmap_top, glyph->bitmap, style.color);
            pen += glyph->advance.x;
        }
    return true;
}

}  // namespace opal
