// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/shape_sampler.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "formats/command.h"
#include "formats/error.h"
#include "formats/random.h"

namespace opal {
namespace {

/// Few samples still need a fair estimate of the volume.
constexpr std::size_t min_hits_for_volume = 10'000;
constexpr std::size_t tries_per_batch = 1 << 16;
constexpr std::size_t tries_for_fill = 1 << 12;
/// The boxes are refined until this part of the tries hits, or there are so many boxes.
constexpr double good_fill = 1.0 / 16.0;
constexpr std::size_t max_boxes = 1 << 20;
constexpr double min_fill = 1.0e-4;

/// Four numbers in [0, 1), a pure function of (seed, k).
std::array<double, 4> uniform4(std::uint64_t seed, std::size_t k) {
    const RandomBlock low = random_block(seed, RandomStream::site_candidates, k, 0);
    const RandomBlock high = random_block(seed, RandomStream::site_candidates, k, 1);
    return {uniform_double(low.value[0], low.value[1]), uniform_double(low.value[2], low.value[3]),
            uniform_double(high.value[0], high.value[1]), uniform_double(high.value[2], high.value[3])};
}

openvdb::Vec3d place_in(const openvdb::BBoxd& box_mm, const std::array<double, 4>& uniform) {
    return box_mm.min() + openvdb::Vec3d(uniform[0], uniform[1], uniform[2]) * box_mm.extents();
}

/// Disjoint boxes that cover the shape.
class Cover {
  public:
    explicit Cover(const Shape& shape) : shape_(shape), boxes_{shape.bounds_mm()} { accumulate(); }

    double volume_mm3() const { return volume_up_to_.back(); }
    std::size_t size() const { return boxes_.size(); }

    openvdb::Vec3d point_mm(std::uint64_t seed, std::size_t k) const {
        const std::array<double, 4> uniform = uniform4(seed, k);
        const auto found = std::upper_bound(volume_up_to_.begin(), volume_up_to_.end() - 1, uniform[3] * volume_mm3());
        return place_in(boxes_[static_cast<std::size_t>(found - volume_up_to_.begin())], uniform);
    }

    /// Part of the first tries that lie inside the shape.
    double fill(std::uint64_t seed) const {
        std::vector<char> inside(tries_for_fill);
        tbb::parallel_for(std::size_t(0), tries_for_fill,
                          [&](std::size_t k) { inside[k] = shape_.contains(point_mm(seed, k)) ? 1 : 0; });
        return static_cast<double>(std::count(inside.begin(), inside.end(), char(1))) / static_cast<double>(tries_for_fill);
    }

    /// Halves the boxes along their longer sides and drops those that lie outside.
    void refine() {
        std::vector<std::vector<openvdb::BBoxd>> kept(boxes_.size());
        tbb::parallel_for(std::size_t(0), boxes_.size(), [&](std::size_t n) {
            for (const openvdb::BBoxd& child : halves(boxes_[n]))
                if (shape_.signed_distance_mm(child.getCenter()) <= 0.5 * child.extents().length() * (1.0 + 1.0e-12))
                    kept[n].push_back(child);
        });
        boxes_.clear();
        for (const auto& children : kept) boxes_.insert(boxes_.end(), children.begin(), children.end());
        if (boxes_.empty()) throw InputError("shape: holds no place for a site");
        accumulate();
    }

  private:
    static std::vector<openvdb::BBoxd> halves(const openvdb::BBoxd& box) {
        const openvdb::Vec3d extents = box.extents();
        const double longest = std::max({extents.x(), extents.y(), extents.z()});
        std::vector<openvdb::BBoxd> parts = {box};
        for (int axis = 0; axis < 3; ++axis) {
            if (2.0 * extents[axis] <= longest) continue;
            const double middle = box.min()[axis] + 0.5 * extents[axis];
            for (std::size_t n = parts.size(); n > 0; --n) {
                openvdb::BBoxd upper = parts[n - 1];
                upper.min()[axis] = middle;
                parts[n - 1].max()[axis] = middle;
                parts.push_back(upper);
            }
        }
        return parts;
    }

    void accumulate() {
        volume_up_to_.clear();
        double sum = 0.0;
        for (const openvdb::BBoxd& box : boxes_) volume_up_to_.push_back(sum += box.volume());
    }

    const Shape& shape_;
    std::vector<openvdb::BBoxd> boxes_;
    std::vector<double> volume_up_to_;
};

Cover fitting_cover(const Shape& shape, std::uint64_t seed) {
    Cover cover(shape);
    for (double fill = cover.fill(seed); fill < good_fill; fill = cover.fill(seed)) {
        throw_if_interrupted();
        if (cover.size() > max_boxes / 8) {
            if (fill < min_fill) throw InputError("shape: is too thin to place sites in: it fills too little of a million boxes");
            break;
        }
        cover.refine();
    }
    return cover;
}

}  // namespace

ShapeSamples sample_uniformly(const Shape& shape, std::size_t count, std::uint64_t seed) {
    const Cover cover = fitting_cover(shape, seed);
    const std::size_t wanted_hits = std::max(count, min_hits_for_volume);
    ShapeSamples samples;
    samples.positions_mm.reserve(count);
    std::size_t hits = 0, tries = 0;
    std::vector<openvdb::Vec3d> points(tries_per_batch);
    std::vector<char> inside(tries_per_batch);
    while (hits < wanted_hits) {
        throw_if_interrupted();
        tbb::parallel_for(std::size_t(0), tries_per_batch, [&](std::size_t n) {
            points[n] = cover.point_mm(seed, tries + n);
            inside[n] = shape.contains(points[n]) ? 1 : 0;
        });
        for (std::size_t n = 0; n < tries_per_batch && hits < wanted_hits; ++n, ++tries) {
            if (inside[n] == 0) continue;
            if (hits < count) samples.positions_mm.push_back(points[n]);
            ++hits;
        }
    }
    samples.shape_volume_mm3 = cover.volume_mm3() * static_cast<double>(hits) / static_cast<double>(tries);
    return samples;
}

std::vector<openvdb::Vec3d> sample_box(const openvdb::BBoxd& box_mm, std::size_t count, std::uint64_t seed) {
    std::vector<openvdb::Vec3d> points(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t k) { points[k] = place_in(box_mm, uniform4(seed, k)); });
    return points;
}

}  // namespace opal
