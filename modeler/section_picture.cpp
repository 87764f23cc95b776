// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/section_picture.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"
#include "modeler/color_map.h"
#include "modeler/picture_page.h"
#include "modeler/section_legend.h"

namespace opal {
namespace {

const openvdb::Vec3f outside_color(0.955f), line_color(0.1f);
constexpr const char* axis_names[] = {"x", "y", "z"};
constexpr int oversampling = 3;
/// Free space around the opal, as a part of the longer side.
constexpr double margin = 0.03;

struct Section {
    const SectionSubject* subject;
    SectionFrame frame;
    SectionRaster raster;
};

struct ValueRange {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

std::vector<double> places_mm(const SectionSubject& subject, const SectionRequest& request) {
    if (!subject.asset->grain_id || !subject.asset->shape)
        throw InputError(fmt::format("{}: holds sites alone; a section needs the grids grain_id and shape", subject.file));
    const SectionRange range = section_range_mm(*subject.asset, request.axis);
    if (request.at_mm) {
        // Half a unit of the sixth digit, with which the range is printed.
        const double slack_mm = 1.0e-6 * std::max(std::abs(range.low_mm), std::abs(range.high_mm));
        if (!(*request.at_mm >= range.low_mm - slack_mm && *request.at_mm <= range.high_mm + slack_mm))
            throw InputError(fmt::format("{}: --at {:.6g}: no section there; allowed along {}: {:.6g} to {:.6g} mm", subject.file,
                                         *request.at_mm, axis_names[request.axis], range.low_mm, range.high_mm));
        return {*request.at_mm};
    }
    std::vector<double> places;
    for (int n = 0; n < request.slices; ++n)
        places.push_back(range.low_mm + (n + 0.5) / request.slices * (range.high_mm - range.low_mm));
    return places;
}

/// All sections in one scale, in frames of one size.
std::vector<Section> lay_out_sections(const std::vector<SectionSubject>& subjects, const SectionRequest& request) {
    std::vector<Section> sections;
    double width_mm = 0.0, height_mm = 0.0;
    for (const SectionSubject& subject : subjects)
        for (const double at_mm : places_mm(subject, request)) {
            const openvdb::Vec3d extents_mm = voxel_bounds_mm(*subject.asset).extents();
            const SectionFrame frame = centered_frame(*subject.asset, request.axis, at_mm, 1.0, 1, 1);
            width_mm = std::max(width_mm, extents_mm[frame.across]);
            height_mm = std::max(height_mm, extents_mm[frame.up]);
            sections.push_back({&subject, frame, {}});
        }
    const double margin_mm = margin * std::max(width_mm, height_mm);
    const double pixel_mm = (std::max(width_mm, height_mm) + 2.0 * margin_mm) / request.size_px;
    const int width = static_cast<int>(std::ceil((width_mm + 2.0 * margin_mm) / pixel_mm - 1.0e-9));
    const int height = static_cast<int>(std::ceil((height_mm + 2.0 * margin_mm) / pixel_mm - 1.0e-9));
    for (Section& section : sections)
        section.frame = centered_frame(*section.subject->asset, request.axis, section.frame.at_mm, pixel_mm, width, height);
    return sections;
}

ValueRange value_range(const std::vector<Section>& sections) {
    ValueRange range;
    for (const Section& section : sections)
        for (std::size_t n = 0; n < section.raster.value.size(); ++n) {
            if (section.raster.label[n] == 0) continue;
            range.low = std::min(range.low, static_cast<double>(section.raster.value[n]));
            range.high = std::max(range.high, static_cast<double>(section.raster.value[n]));
        }
    return range;
}

std::vector<openvdb::Vec3f> grain_colors(const OpalAsset& asset, const SectionRequest& request) {
    std::vector<openvdb::Vec3f> colors(asset.num_grains() + 1, outside_color);
    openvdb::Vec3f axis(0.0f);
    axis[request.axis] = 1.0f;
    for (std::size_t grain = 1; grain < colors.size(); ++grain) {
        // Display colours differ in hue alone; neighbours of like hue are told apart by their lightness (steps of the square of
        // the plastic ratio's inverse fill the interval evenly).
        const double step = 0.5698402909980532 * static_cast<double>(grain);
        const openvdb::Vec3f display =
            grain_display_color(static_cast<std::int32_t>(grain)) * static_cast<float>(0.7 + 0.3 * (step - std::floor(step)));
        if (request.color == SectionColor::orientation)
            colors[grain] = cubic_direction_color(asset.grain_orientations[grain - 1].inverse().rotateVector(axis));
        else
            colors[grain] = request.color == SectionColor::sites ? 0.4f * display + openvdb::Vec3f(0.6f) : display;
    }
    return colors;
}

/// Colours a section's samples and averages them over each pixel.
void paint(PicturePage& page, const PageRectangle& place, const Section& section, const SectionRequest& request,
           const ValueRange& range) {
    const SectionRaster& raster = section.raster;
    const double line_px = std::max(1.2, request.size_px / 600.0);
    const std::vector<SectionLine> lines = trace_lines(raster, 0.5 * line_px * oversampling);
    const bool field = is_field(request.color);
    const std::vector<openvdb::Vec3f> colors =
        field ? std::vector<openvdb::Vec3f>() : grain_colors(*section.subject->asset, request);
    const double per_value = range.high > range.low ? 1.0 / (range.high - range.low) : 0.0;
    const auto color_of = [&](std::size_t n) -> openvdb::Vec3f {
        if (lines[n] != SectionLine::none) return line_color;
        if (raster.label[n] == 0) return outside_color;
        return field ? viridis((static_cast<double>(raster.value[n]) - range.low) * per_value)
                     : colors[static_cast<std::size_t>(raster.label[n])];
    };
    tbb::parallel_for(0, place.height, [&](int y) {
        for (int x = 0; x < place.width; ++x) {
            openvdb::Vec3f sum(0.0f);
            for (int n = 0; n < oversampling * oversampling; ++n)
                sum += color_of(raster.index(x * oversampling + n % oversampling, y * oversampling + n / oversampling));
            page.blend(place.x + x, place.y + y, sum / float(oversampling * oversampling));
        }
    });
}

/// Sites up to this far from a plane are shown on it.
double shown_site_depth_mm(const OpalAsset& asset) {
    const openvdb::Vec3d extents_mm = voxel_bounds_mm(asset).extents();
    return 0.5 * std::cbrt(extents_mm.product() / static_cast<double>(std::max<std::size_t>(1, asset.sites.size())));
}

/// Dots where the sites near the plane are, fainter the farther away; hidden sites, which own nothing, as white ones.
void paint_sites(PicturePage& page, const PageRectangle& place, const Section& section) {
    const double depth_mm = shown_site_depth_mm(*section.subject->asset);
    const double radius_px = std::clamp(0.12 * depth_mm / section.frame.pixel_mm, 1.0, 8.0);
    for (const Site& site : section.subject->asset->sites) {
        const openvdb::Vec3d pixel = section.frame.pixel_of(site.position_mm);
        if (std::abs(pixel.z()) > depth_mm || pixel.x() < 0.0 || pixel.y() < 0.0 || pixel.x() >= place.width ||
            pixel.y() >= place.height)
            continue;
        const double strength = 1.0 - 0.85 * std::abs(pixel.z()) / depth_mm;
        page.disc(place.x + pixel.x(), place.y + pixel.y(), radius_px, openvdb::Vec3f(0.0f), strength);
        if (site.grain == 0) page.disc(place.x + pixel.x(), place.y + pixel.y(), 0.6 * radius_px, openvdb::Vec3f(1.0f), strength);
    }
}

std::string color_title(const SectionRequest& request, const OpalAsset& asset) {
    switch (request.color) {
        case SectionColor::orientation:
            return fmt::format("lattice direction along {}", axis_names[request.axis]);
        case SectionColor::sites:
            return "sites and grains";
        case SectionColor::weight:
            return fmt::format("{}{}", asset.weight ? "weight" : "weight of the nearest site",
                               asset.tessellation == TessellationKind::multiplicative ? "" : " (mm)");
        case SectionColor::sigma_a_scale:
            return "factor on the absorption";
        case SectionColor::sigma_s_rayleigh:
            return "Rayleigh scattering at 400 nm (1/mm)";
        case SectionColor::sigma_s_mie:
            return "Mie scattering (1/mm)";
        default:
            return "grains";
    }
}

/// Sizes on the page, all following from the size of the text.
struct Layout {
    int text_px, columns, rows, left_px, top_px, gap_px, right_px, bottom_px;

    Layout(const std::vector<Section>& sections, std::size_t num_subjects, const SectionRequest& request) {
        const int count = static_cast<int>(sections.size()), subjects = static_cast<int>(num_subjects);
        text_px = std::max(14, request.size_px / 42);
        const bool table = subjects > 1 && count > subjects;
        columns = table ? count / subjects : count <= 3 ? count : static_cast<int>(std::ceil(std::sqrt(count)));
        rows = (count + columns - 1) / columns;
        const bool single = count == 1;
        left_px = single ? 9 * text_px / 2 : text_px;
        top_px = 2 * text_px;
        gap_px = text_px;
        right_px = is_field(request.color)                      ? 13 * text_px / 2
                   : request.color == SectionColor::orientation ? 17 * text_px / 2
                                                                : text_px;
        bottom_px = single ? 6 * text_px : 3 * text_px;
    }

    PageRectangle place(std::size_t n, const SectionFrame& frame) const {
        const int column = static_cast<int>(n) % columns, row = static_cast<int>(n) / columns;
        return {left_px + column * (frame.width + gap_px), top_px + row * (frame.height + gap_px + top_px), frame.width,
                frame.height};
    }
    PicturePage page(const SectionFrame& frame) const {
        return {left_px + columns * (frame.width + gap_px) - gap_px + right_px,
                rows * (top_px + frame.height + gap_px) - gap_px + bottom_px};
    }
};

void write_captions(PicturePage& page, const Layout& layout, const std::vector<Section>& sections, bool several_opals,
                    const SectionRequest& request) {
    for (std::size_t n = 0; n < sections.size(); ++n) {
        const Section& section = sections[n];
        const PageRectangle place = layout.place(n, section.frame);
        const bool at_zero = std::abs(section.frame.at_mm) < 1.0e-3 * section.frame.pixel_mm;  // but for rounding
        std::string caption = fmt::format("{} = {:.4g} mm", axis_names[request.axis], at_zero ? 0.0 : section.frame.at_mm);
        if (several_opals) caption = section.subject->title + ", " + caption;
        if (sections.size() == 1) caption = color_title(request, *section.subject->asset) + ", " + caption;
        page.text(place.x, place.y - layout.text_px, caption, layout.text_px, TextAlign::left);
        if (sections.size() > 1) page.frame(place.x, place.y, place.width, place.height, openvdb::Vec3f(0.8f));
    }
}

void write_footer(PicturePage& page, const Layout& layout, const std::vector<Section>& sections, const SectionRequest& request) {
    const Section& first = sections.front();
    const OpalAsset& asset = *first.subject->asset;
    const PageRectangle last = layout.place(sections.size() - 1, first.frame);
    const int y = page.image().height - 3 * layout.text_px / 2;
    const int right = layout.left_px + layout.columns * (last.width + layout.gap_px) - layout.gap_px;
    draw_scale_bar(page, layout.left_px, y, last.width, first.frame.pixel_mm, layout.text_px);
    std::string text;
    if (sections.size() > 1)
        text = fmt::format("{}; {} to the right, {} up", color_title(request, asset), axis_names[first.frame.across],
                           axis_names[first.frame.up]);
    if (request.color == SectionColor::sites)
        text += fmt::format("{}dots: sites up to {:.2g} mm away", text.empty() ? "" : "; ", shown_site_depth_mm(asset));
    else if (sections.size() == 1)
        text = fmt::format("voxels of {:.3g} mm", asset.grain_id->voxelSize().x());
    page.text(right, y, text, layout.text_px, TextAlign::right);
}

void draw_key(PicturePage& page, const Layout& layout, const SectionFrame& frame, const SectionRequest& request,
              const ValueRange& range) {
    const int x = page.image().width - layout.right_px + layout.text_px;
    const int text = layout.text_px;
    if (is_field(request.color))
        draw_color_bar(page, {x, layout.top_px, 5 * text / 4, frame.height}, range.low, range.high, text);
    else if (request.color == SectionColor::orientation)
        draw_orientation_key(page, x + text / 2, layout.top_px + 2 * text, 6 * text, text);
}

}  // namespace

Image draw_sections(const std::vector<SectionSubject>& subjects, const SectionRequest& request) {
    std::vector<Section> sections = lay_out_sections(subjects, request);
    for (Section& section : sections) {
        try {
            section.raster = sample_section(*section.subject->asset, section.frame, request.color, oversampling);
        } catch (const InputError& error) {
            throw InputError(fmt::format("{}: {}", section.subject->file, error.what()));
        }
    }
    const ValueRange range = value_range(sections);
    const Layout layout(sections, subjects.size(), request);
    PicturePage page = layout.page(sections.front().frame);
    for (std::size_t n = 0; n < sections.size(); ++n) {
        const PageRectangle place = layout.place(n, sections[n].frame);
        paint(page, place, sections[n], request, range);
        if (request.color == SectionColor::sites) paint_sites(page, place, sections[n]);
    }
    write_captions(page, layout, sections, subjects.size() > 1, request);
    if (sections.size() == 1) draw_axes(page, layout.place(0, sections[0].frame), sections[0].frame, layout.text_px);
    draw_key(page, layout, sections.front().frame, request, range);
    write_footer(page, layout, sections, request);
    return page.image();
}

}  // namespace opal
