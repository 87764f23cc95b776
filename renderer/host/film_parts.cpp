// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/film_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "formats/error.h"
#include "renderer/host/render_fingerprint.h"

namespace opal {
namespace {

constexpr std::uint32_t most_samples = 1u << 24;

/// Reads a whole number at the beginning of `text` and takes it away; false where there is none.
bool take_number(std::string_view& text, std::uint32_t& number) {
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return false;
    text.remove_prefix(std::size_t(next - text.data()));
    return true;
}

bool take(std::string_view& text, char c) {
    if (text.empty() || text.front() != c) return false;
    text.remove_prefix(1);
    return true;
}

const std::string& attribute_of(const Image& image, const char* name, const std::string& part) {
    const auto found = image.attributes.find(name);
    if (found == image.attributes.end())
        throw InputError(fmt::format("{}: not a part of a render: it was made without --samples", part));
    return found->second;
}

bool is_spectral(const Image& image) {
    return image.find_channel("S0.360nm") >= 0;
}

/// Indices of the words that hold the sums: low, high, low, high ...
std::vector<std::size_t> word_places(const FilmPart& part) {
    std::vector<std::size_t> places;
    for (const std::string& name : exact_names(is_spectral(part.image)))
        for (const char* half : {".low", ".high"}) {
            const auto& names = part.image.word_names;
            const auto found = std::find(names.begin(), names.end(), "exact." + name + half);
            if (found == names.end())
                throw InputError(fmt::format("{}: the channel exact.{}{} is missing", part.name, name, half));
            places.push_back(std::size_t(found - names.begin()));
        }
    return places;
}

/// Place of a sum of `exact_names` among the film's.
int film_place(std::size_t exact) {
    return exact < 6 ? int(exact) : spectrum_offset + int(exact) - 6;
}

void require_finite(const FilmPart& part) {
    const std::vector<float>& pixels = part.image.pixels;
    const auto broken = std::find_if_not(pixels.begin(), pixels.end(), [](float value) { return std::isfinite(value); });
    if (broken == pixels.end()) return;
    const std::size_t place = std::size_t(broken - pixels.begin()), channels = part.image.channel_names.size();
    const std::size_t pixel = place / channels, width = std::size_t(part.image.width);
    throw InputError(fmt::format("{}: damaged: {} of pixel ({}, {}) is {}", part.name, part.image.channel_names[place % channels],
                                 pixel % width, pixel / width, *broken));
}

PixelWindow window_of(const Image& image) {
    return {image.x0, image.y0, image.x0 + image.width, image.y0 + image.height};
}

}  // namespace

std::vector<SampleRange> parse_sample_ranges(const std::string& text, const std::string& where) {
    std::vector<SampleRange> ranges;
    std::string_view left = text;
    do {
        SampleRange range;
        if (!take_number(left, range.first) || !take(left, ':') || !take_number(left, range.end) || range.first >= range.end ||
            range.end > most_samples)
            throw InputError(
                fmt::format("{}: '{}' is no range of samples; expected A:B with 0 <= A < B <= {}", where, text, most_samples));
        ranges.push_back(range);
    } while (take(left, ','));
    if (!left.empty()) throw InputError(fmt::format("{}: '{}' is no range of samples; expected A:B", where, text));
    return ranges;
}

std::string sample_ranges_text(const std::vector<SampleRange>& ranges) {
    std::string text;
    for (const SampleRange& range : ranges) text += fmt::format("{}{}:{}", text.empty() ? "" : ",", range.first, range.end);
    return text;
}

std::vector<std::string> exact_names(bool spectral) {
    std::vector<std::string> names = {"sum.R", "sum.G", "sum.B", "square.R", "square.G", "square.B"};
    if (spectral)
        for (int bin = 0; bin < num_bins; ++bin) names.push_back(fmt::format("S0.{}nm", int(bin_centre_nm(bin))));
    return names;
}

void add_exact_sums(const Film& film, Image& image) {
    const std::vector<std::string> names = exact_names(film.spectral());
    image.word_names.clear();
    for (const std::string& name : names)
        for (const char* half : {".low", ".high"}) image.word_names.push_back("exact." + name + half);
    const std::uint32_t pixels = std::uint32_t(film.width() * film.height());
    image.words.clear();
    image.words.reserve(pixels * image.word_names.size());
    for (std::uint32_t p = 0; p < pixels; ++p)
        for (std::size_t k = 0; k < names.size(); ++k) {
            const auto bits = std::bit_cast<std::uint64_t>(film.sums(p)[std::size_t(film_place(k))]);
            image.words.push_back(std::uint32_t(bits));
            image.words.push_back(std::uint32_t(bits >> 32));
        }
}

FilmPart read_part(const std::filesystem::path& path) {
    FilmPart part;
    part.name = path.string();
    part.image = read_image(path);
    part.ranges = parse_sample_ranges(attribute_of(part.image, samples_attribute, part.name), part.name);
    part.fingerprint = attribute_of(part.image, fingerprint_attribute, part.name);
    std::string_view whole = attribute_of(part.image, all_samples_attribute, part.name);
    if (!take_number(whole, part.all_samples) || !whole.empty())
        throw InputError(fmt::format("{}: the header's {} is damaged", part.name, all_samples_attribute));
    read_words(path, part.image);

    require_finite(part);
    std::uint32_t expected = 0;
    for (const SampleRange& range : part.ranges) expected += range.end - range.first;
    const int counts = part.image.find_channel("sample_count");
    if (counts < 0) throw InputError(fmt::format("{}: the channel sample_count is missing", part.name));
    for (int y = 0; y < part.image.height; ++y)
        for (int x = 0; x < part.image.width; ++x)
            if (part.image.pixel(x, y)[counts] != float(expected))
                throw InputError(
                    fmt::format("{}: not finished: pixel ({}, {}) has {} of the {} samples of {}; continue it with "
                                "--resume first",
                                part.name, x, y, part.image.pixel(x, y)[counts], expected, sample_ranges_text(part.ranges)));
    return part;
}

PartMerger::PartMerger(FilmPart first)
    : first_(std::move(first)),
      film_(window_of(first_.image), first_.image.full_width > 0 ? first_.image.full_width : first_.image.width,
            first_.image.full_height > 0 ? first_.image.full_height : first_.image.height, is_spectral(first_.image)) {
    add_sums(first_);
    first_.image.words.clear();
}

void PartMerger::add(const FilmPart& part) {
    const std::string difference = fingerprint_difference(first_.fingerprint, first_.name, part.fingerprint, part.name);
    if (!difference.empty()) throw InputError(fmt::format("{}: not of the same render: {}", part.name, difference));
    if (window_of(part.image) != window_of(first_.image) || is_spectral(part.image) != is_spectral(first_.image) ||
        part.all_samples != first_.all_samples)
        throw InputError(
            fmt::format("{}: not of the same render as {}: another size, other layers, or {} samples per pixel in all "
                        "in place of {}",
                        part.name, first_.name, part.all_samples, first_.all_samples));
    add_sums(part);
}

void PartMerger::add_sums(const FilmPart& part) {
    for (const SampleRange& range : part.ranges) {
        for (const Held& held : held_)
            if (range.first < held.range.end && held.range.first < range.end)
                throw InputError(fmt::format("{}: its samples {}:{} overlap {}:{} of {}", part.name, range.first, range.end,
                                             held.range.first, held.range.end, held.part));
        held_.push_back({range, part.name});
    }
    std::sort(held_.begin(), held_.end(), [](const Held& a, const Held& b) { return a.range.first < b.range.first; });
    const std::vector<std::size_t> places = word_places(part);
    const std::size_t words = part.image.word_names.size();
    const int counts = part.image.find_channel("sample_count");
    for (std::uint32_t p = 0; p < std::uint32_t(film_.width() * film_.height()); ++p) {
        const std::span<double> sums = film_.sums(p);
        for (std::size_t k = 0; k < places.size() / 2; ++k) {
            const std::uint64_t low = part.image.words[p * words + places[2 * k]];
            const std::uint64_t high = part.image.words[p * words + places[2 * k + 1]];
            const double sum = std::bit_cast<double>(low | high << 32);
            if (!std::isfinite(sum)) throw InputError(fmt::format("{}: damaged: pixel {} holds no finite sum", part.name, p));
            sums[std::size_t(film_place(k))] += sum;
        }
        const int width = part.image.width;
        film_.set_samples(p, film_.samples(p) + std::uint32_t(part.image.pixel(int(p) % width, int(p) / width)[counts]));
    }
}

std::vector<SampleRange> PartMerger::missing() const {
    std::vector<SampleRange> gaps;
    std::uint32_t reached = 0;
    for (const Held& held : held_) {
        if (held.range.first > reached) gaps.push_back({reached, held.range.first});
        reached = held.range.end;
    }
    if (reached < first_.all_samples) gaps.push_back({reached, first_.all_samples});
    return gaps;
}

Image PartMerger::merged() const {
    const Image sums = film_.to_image();
    Image image = first_.image;
    image.word_names.clear();
    image.channel_names.clear();
    struct Source {
        bool summed;
        int channel;
    };
    std::vector<Source> sources;
    for (int c = 0; c < first_.image.num_channels(); ++c) {
        const std::string& name = first_.image.channel_names[std::size_t(c)];
        // The part's words, read as floats, are no channels of the picture.
        if (name.starts_with("exact.")) continue;
        const int summed = sums.find_channel(name);
        sources.push_back({summed >= 0, summed >= 0 ? summed : c});
        image.channel_names.push_back(name);
    }
    image.pixels.clear();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (const Source& source : sources)
                image.pixels.push_back((source.summed ? sums : first_.image).pixel(x, y)[source.channel]);
    // What the library that read the file added is not the picture's.
    std::erase_if(image.attributes,
                  [](const auto& attribute) { return !attribute.first.starts_with("opal:") && attribute.first != "Software"; });
    image.attributes.insert(sums.attributes.begin(), sums.attributes.end());
    if (missing().empty()) {
        for (const char* attribute : {samples_attribute, all_samples_attribute, fingerprint_attribute})
            image.attributes.erase(attribute);
        return image;
    }
    std::vector<SampleRange> ranges;
    for (const Held& held : held_) ranges.push_back(held.range);
    image.attributes[samples_attribute] = sample_ranges_text(ranges);
    add_exact_sums(film_, image);
    return image;
}

}  // namespace opal
