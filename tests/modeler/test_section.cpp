// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/LevelSetPlatonic.h>

#include <cmath>

#include "modeler/color_map.h"
#include "modeler/picture_page.h"
#include "modeler/section_picture.h"
#include "modeler/section_raster.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::input_error_of;
using testing_tools::with_threads;

constexpr double voxel_mm = 0.1;
const openvdb::Vec3d box_low_mm(-1.55, -1.05, 0.45), box_high_mm(2.55, 1.05, 3.05);

/// Octant of a point around a corner that is in the middle of no side, from 1.
std::int32_t octant(const openvdb::Vec3d& p) {
    return 1 + (p.x() > 0.05 ? 1 : 0) + (p.y() > -0.35 ? 2 : 0) + (p.z() > 1.25 ? 4 : 0);
}

/// A box cut into eight grains, whose sizes tell all axes and directions apart; faces between voxels.
OpalAsset octant_box() {
    initialize_openvdb();
    OpalAsset asset;
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel_mm);
    asset.shape = openvdb::tools::createLevelSetBox<openvdb::FloatGrid>(
        openvdb::math::BBox<openvdb::Vec3f>(openvdb::Vec3f(box_low_mm), openvdb::Vec3f(box_high_mm)), *transform);
    asset.grain_id = openvdb::Int32Grid::create(0);
    asset.grain_id->setTransform(transform);
    auto ids = asset.grain_id->getAccessor();
    for (int i = -15; i <= 25; ++i)
        for (int j = -10; j <= 10; ++j)
            for (int k = 5; k <= 30; ++k) ids.setValueOn({i, j, k}, octant(voxel_mm * openvdb::Vec3d(i, j, k)));
    asset.grain_id->pruneGrid();
    for (std::uint64_t grain = 1; grain <= 8; ++grain) asset.grain_orientations.push_back(random_orientation(3, false, grain));
    asset.sites = testing_tools::random_sites({box_low_mm, box_high_mm}, 40, 0.2, 5);
    for (Site& site : asset.sites) site.grain = octant(site.position_mm);
    return asset;
}

openvdb::Vec3f page_color(const Image& image, int x, int y) {
    return {image.pixel(x, y)[0], image.pixel(x, y)[1], image.pixel(x, y)[2]};
}

TEST(SectionFrame, PixelsAndMillimetresMapOntoEachOther) {
    const OpalAsset asset = octant_box();
    const SectionFrame frame = centered_frame(asset, 2, 1.0, 0.05, 100, 60);
    // The middle of the voxels' extent, (0.5, 0), is the middle of the picture.
    EXPECT_LT((frame.point_mm(50.0, 30.0) - openvdb::Vec3d(0.5, 0.0, 1.0)).length(), 1e-12);
    EXPECT_LT((frame.point_mm(0.5, 0.5) - openvdb::Vec3d(0.5 - 49.5 * 0.05, 29.5 * 0.05, 1.0)).length(), 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
        const SectionFrame other = centered_frame(asset, axis, 0.7, 0.03, 90, 70);
        const openvdb::Vec3d back = other.pixel_of(other.point_mm(12.25, 61.5));
        EXPECT_LT((back - openvdb::Vec3d(12.25, 61.5, 0.0)).length(), 1e-9);
        openvdb::Vec3d in_front = other.point_mm(12.25, 61.5);
        in_front[axis] += 0.2;
        EXPECT_NEAR(other.pixel_of(in_front).z(), 0.2, 1e-12);
    }
}

TEST(SectionRaster, ShowsTheGrainOfEveryPointInEveryDirection) {
    const OpalAsset asset = octant_box();
    const double places_mm[3][2] = {{-0.8, 1.7}, {-0.7, 0.4}, {0.9, 2.0}};
    for (int axis = 0; axis < 3; ++axis)
        for (const double at_mm : places_mm[axis]) {
            const SectionFrame frame = centered_frame(asset, axis, at_mm, 0.05, 96, 72);
            const SectionRaster raster = sample_section(asset, frame, SectionColor::grain, 2);
            ASSERT_EQ(raster.width, 192);
            int inside = 0;
            for (int row = 0; row < raster.height; ++row)
                for (int column = 0; column < raster.width; ++column) {
                    const openvdb::Vec3d p = frame.point_mm((column + 0.5) / 2.0, (row + 0.5) / 2.0);
                    double depth_mm = 1.0;  // into the box
                    int faces_within_a_voxel = 0;
                    for (int c = 0; c < 3; ++c) {
                        const double face_mm = std::min(p[c] - box_low_mm[c], box_high_mm[c] - p[c]);
                        depth_mm = std::min(depth_mm, face_mm);
                        if (std::abs(face_mm) < voxel_mm) ++faces_within_a_voxel;
                    }
                    // Interpolated distances to one face are exact; they round the edges where two meet in a voxel.
                    if (std::abs(depth_mm) < 0.01 || faces_within_a_voxel > 1) continue;
                    const std::int32_t expected = depth_mm > 0.0 ? octant(p) : 0;
                    ASSERT_EQ(raster.label[raster.index(column, row)], expected)
                        << "axis " << axis << " at " << p.x() << " " << p.y() << " " << p.z();
                    inside += expected > 0;
                }
            EXPECT_GT(inside, 5000);
        }
}

TEST(SectionRaster, LinesLieOnBoundariesAndNowhereElse) {
    // Columns 0 to 9 outside, then grain 1 up to 29, then grain 2.
    SectionRaster raster;
    raster.width = 60;
    raster.height = 20;
    raster.label.assign(1200, 2);
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 30; ++column) raster.label[raster.index(column, row)] = column < 10 ? 0 : 1;
    const std::vector<SectionLine> lines = trace_lines(raster, 1.6);
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 60; ++column) {
            const double to_outline = std::abs(column - 9.5), to_boundary = std::abs(column - 29.5);
            const SectionLine expected = to_outline <= 3.2    ? SectionLine::outline
                                         : to_boundary <= 1.6 ? SectionLine::grain_boundary
                                                              : SectionLine::none;
            ASSERT_EQ(lines[raster.index(column, row)], expected) << column;
        }
}

TEST(SectionRaster, WithoutAGridTheWeightIsThatOfTheNearestSite) {
    const OpalAsset asset = octant_box();
    const SectionFrame frame = centered_frame(asset, 1, 0.2, 0.1, 48, 40);
    const SectionRaster raster = sample_section(asset, frame, SectionColor::weight, 1);
    for (int row = 0; row < frame.height; ++row)
        for (int column = 0; column < frame.width; ++column) {
            if (raster.label[raster.index(column, row)] == 0) continue;
            const openvdb::Vec3d p = frame.point_mm(column + 0.5, row + 0.5);
            const auto nearest = std::min_element(asset.sites.begin(), asset.sites.end(), [&](const Site& a, const Site& b) {
                return (a.position_mm - p).lengthSqr() < (b.position_mm - p).lengthSqr();
            });
            ASSERT_EQ(raster.value[raster.index(column, row)], nearest->weight_mm);
        }
}

TEST(SectionRaster, FieldsAreInterpolatedLinearly) {
    OpalAsset asset = octant_box();
    asset.sigma_s_mie = openvdb::FloatGrid::create(0.0f);
    asset.sigma_s_mie->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    auto values = asset.sigma_s_mie->getAccessor();
    const auto field = [](const openvdb::Vec3d& p) { return 3.0 + 0.5 * p.x() - 0.25 * p.y() + p.z(); };
    for (int i = -5; i <= 7; ++i)
        for (int j = -4; j <= 4; ++j)
            for (int k = -1; k <= 8; ++k) values.setValueOn({i, j, k}, static_cast<float>(field(0.5 * openvdb::Vec3d(i, j, k))));
    const SectionFrame frame = centered_frame(asset, 2, 1.3, 0.1, 48, 30);
    const SectionRaster raster = sample_section(asset, frame, SectionColor::sigma_s_mie, 1);
    for (int row = 0; row < frame.height; ++row)
        for (int column = 0; column < frame.width; ++column) {
            if (raster.label[raster.index(column, row)] == 0) continue;
            const openvdb::Vec3d p = frame.point_mm(column + 0.5, row + 0.5);
            ASSERT_NEAR(raster.value[raster.index(column, row)], field(p), 1e-5);
        }
}

TEST(SectionPicture, SameInputSamePixelsOnAnyThreads) {
    const OpalAsset asset = octant_box();
    const std::vector<SectionSubject> subjects = {{&asset, "a.vdb", "a"}};
    for (const SectionColor color : {SectionColor::grain, SectionColor::orientation, SectionColor::sites, SectionColor::weight}) {
        SectionRequest request;
        request.color = color;
        request.slices = 2;
        request.size_px = 150;
        const Image one = with_threads(1, [&] { return draw_sections(subjects, request); });
        const Image four = with_threads(4, [&] { return draw_sections(subjects, request); });
        EXPECT_TRUE(one.pixels == four.pixels);
    }
}

TEST(SectionPicture, ColoursTellGrainsApartAndOrientationsTheirAxis) {
    OpalAsset asset = octant_box();
    // Grain 8's [111] lies along z; every other grain's [100] does.
    const openvdb::Vec3f diagonal = openvdb::Vec3f(1.0f).unit(), z(0.0f, 0.0f, 1.0f);
    const openvdb::Vec3f turn = diagonal.cross(z);
    const float angle = std::acos(diagonal.dot(z));
    for (auto& orientation : asset.grain_orientations) orientation = openvdb::math::Quat<float>(0.0f, 0.0f, 0.0f, 1.0f);
    asset.grain_orientations[7] = openvdb::math::Quat<float>(turn.unit(), angle);

    SectionRequest request;
    request.at_mm = 2.0;
    request.size_px = 200;
    // In the picture, across z: x in [-1.55, 2.55] spans 200 px but for its margins; the cut at x = 0.05 lies at 0.39 of it, y =
    // -0.35 below the middle.
    const auto at = [&](const Image& image, double x_mm, double y_mm) {
        const SectionFrame frame = centered_frame(asset, 2, 2.0, 4.1 * 1.06 / 200.0, 200, 106);
        const openvdb::Vec3d pixel = frame.pixel_of({x_mm, y_mm, 2.0});
        // The section's place on the page: margins of 4.5 and 2 lines of 14 px.
        return page_color(image, 63 + static_cast<int>(pixel.x()), 28 + static_cast<int>(pixel.y()));
    };
    request.color = SectionColor::orientation;
    const Image orientation = draw_sections({{&asset, "a.vdb", "a"}}, request);
    EXPECT_LT((at(orientation, 1.5, 0.5) - openvdb::Vec3f(0.0f, 0.0f, 1.0f)).length(), 2e-3f);
    EXPECT_LT((at(orientation, -1.0, 0.5) - openvdb::Vec3f(1.0f, 0.0f, 0.0f)).length(), 2e-3f);
    EXPECT_LT((at(orientation, 1.5, -0.8) - openvdb::Vec3f(1.0f, 0.0f, 0.0f)).length(), 2e-3f);

    request.color = SectionColor::grain;
    const Image grains = draw_sections({{&asset, "a.vdb", "a"}}, request);
    const openvdb::Vec3f five = at(grains, -1.0, -0.8), six = at(grains, 1.5, -0.8), seven = at(grains, -1.0, 0.5);
    EXPECT_EQ(five, at(grains, -0.3, -0.6));
    EXPECT_GT((five - six).length(), 0.2f);
    EXPECT_GT((five - seven).length(), 0.2f);
    // Dark at the boundary between grains 5 and 6, light outside.
    EXPECT_LT(at(grains, 0.05, -0.8).length(), 0.6f);
    EXPECT_GT(at(grains, 2.6, 0.5).length(), 1.6f);
}

TEST(SectionPicture, WhatCannotBeShownIsNamed) {
    OpalAsset asset = octant_box();
    const std::vector<SectionSubject> subjects = {{&asset, "a.vdb", "a"}};
    SectionRequest request;
    request.size_px = 64;
    request.at_mm = 3.2;
    EXPECT_EQ(input_error_of([&] { draw_sections(subjects, request); }),
              "a.vdb: --at 3.2: no section there; allowed along z: 0.5 to 3 mm");
    for (const double edge_mm : {0.5, 3.0}) {
        request.at_mm = edge_mm;
        EXPECT_EQ(input_error_of([&] { draw_sections(subjects, request); }), "");
    }
    request.at_mm.reset();
    request.color = SectionColor::sigma_a_scale;
    EXPECT_EQ(input_error_of([&] { draw_sections(subjects, request); }),
              "a.vdb: no grid sigma_a_scale: in this opal it does not vary from place to place");
    request.color = SectionColor::weight;
    asset.sites.clear();
    EXPECT_EQ(input_error_of([&] { draw_sections(subjects, request); }),
              "a.vdb: no grid weight and no sites, so there are no weights to show");
    asset.grain_id = nullptr;
    EXPECT_EQ(input_error_of([&] { draw_sections(subjects, request); }),
              "a.vdb: holds sites alone; a section needs the grids grain_id and shape");
}

TEST(ColorMap, ViridisPassesThroughItsTable) {
    // Every 32nd entry of the published table (as R's viridis(9) prints it).
    const int table[9][3] = {{0x44, 0x01, 0x54}, {0x47, 0x2D, 0x7B}, {0x3B, 0x52, 0x8B}, {0x2C, 0x72, 0x8E}, {0x21, 0x90, 0x8C},
                             {0x27, 0xAD, 0x81}, {0x5D, 0xC8, 0x63}, {0xAA, 0xDC, 0x32}, {0xFD, 0xE7, 0x25}};
    for (int n = 0; n < 9; ++n)
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(viridis(n / 8.0)[channel], table[n][channel] / 255.0, 0.02) << n << " " << channel;
    EXPECT_EQ(viridis(-1.0), viridis(0.0));
    EXPECT_EQ(viridis(2.0), viridis(1.0));
}

TEST(ColorMap, OrientationColoursHaveCubicSymmetry) {
    EXPECT_EQ(cubic_direction_color({0, 0, -2}), openvdb::Vec3f(1, 0, 0));
    EXPECT_EQ(cubic_direction_color({0, 3, 3}), openvdb::Vec3f(0, 1, 0));
    EXPECT_EQ(cubic_direction_color({-1, 1, 1}), openvdb::Vec3f(0, 0, 1));
    const double c[3] = {0.9, -0.4, 0.2};
    const openvdb::Vec3f color = cubic_direction_color({c[0], c[1], c[2]});
    const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : orders)
        for (int signs = 0; signs < 8; ++signs)
            EXPECT_EQ(cubic_direction_color({(signs & 1 ? -1 : 1) * c[order[0]], (signs & 2 ? -1 : 1) * c[order[1]],
                                             (signs & 4 ? -1 : 1) * c[order[2]]}),
                      color);
    EXPECT_GT((cubic_direction_color({0.9, -0.4, 0.3}) - color).length(), 0.05f);
}

TEST(PicturePage, TicksAreRound) {
    EXPECT_DOUBLE_EQ(round_step(0.9), 0.5);
    EXPECT_DOUBLE_EQ(round_step(1.0), 1.0);
    EXPECT_DOUBLE_EQ(round_step(4.9), 2.0);
    EXPECT_DOUBLE_EQ(round_step(0.0007), 0.0005);
    EXPECT_EQ(round_ticks(-1.2, 2.1, 5), (std::vector<double>{-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0}));
    EXPECT_EQ(round_ticks(0.0, 10.0, 6), (std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0}));
    EXPECT_TRUE(round_ticks(1.0, 1.0, 6).empty());
}

}  // namespace
}  // namespace opal
