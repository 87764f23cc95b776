// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "renderer/host/film.h"

/// Pictures of a range of samples, such as several computers make of one scene, and the whole that they add up to. A part's EXR
/// is a picture like any other; besides, it holds the film's double-precision sums bit for bit as channels of 32-bit words
/// (exact.<name>.low and .high) and says in its header which samples of which render it holds.
namespace opal {

/// Samples [first, end) of every pixel.
struct SampleRange {
    std::uint32_t first = 0, end = 0;

    bool operator==(const SampleRange&) const = default;
};

/// "A:B" or "A:B,C:D". Throws InputError where it is not such a list with A < B; `where` says whose it is.
std::vector<SampleRange> parse_sample_ranges(const std::string& text, const std::string& where);
std::string sample_ranges_text(const std::vector<SampleRange>& ranges);

/// Header attributes of a part.
inline constexpr const char* samples_attribute = "opal:samples";          ///< the ranges it holds
inline constexpr const char* all_samples_attribute = "opal:all_samples";  ///< samples per pixel of the whole
inline constexpr const char* fingerprint_attribute = "opal:fingerprint";

/// What of a film a part must hold: the sums of samples, of their squares, and spectral layers.
std::vector<std::string> exact_names(bool spectral);

/// Adds a film's sums to its picture as words.
void add_exact_sums(const Film& film, Image& image);

/// A picture and what its header says.
struct FilmPart {
    std::string name;  ///< for messages
    Image image;       ///< with words
    std::string fingerprint;
    std::vector<SampleRange> ranges;
    std::uint32_t all_samples = 0;
};

/// Reads a part. Throws InputError where it is none, is damaged, or does not have all the samples it was to have.
FilmPart read_part(const std::filesystem::path& path);

/// Gathers parts one by one. Parts of different renders, pictures or overlapping ranges are refused by InputError.
class PartMerger {
  public:
    explicit PartMerger(FilmPart first);
    void add(const FilmPart& part);

    /// Ranges that no part holds.
    std::vector<SampleRange> missing() const;
    /// The picture of all samples added: where none is missing, as if it had been rendered in one piece; else a part again.
    Image merged() const;

  private:
    void add_sums(const FilmPart& part);

    struct Held {
        SampleRange range;
        std::string part;
    };

    FilmPart first_;
    Film film_;
    std::vector<Held> held_;  ///< in the order of samples
};

}  // namespace opal
