// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sample_elimination.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "modeler/point_grid.h"

namespace opal {
namespace {

/// What neighbours at a distance add to each other's crowding.
class Crowding {
  public:
    Crowding(std::size_t samples, std::size_t target, double reach) : reach_(reach) {
        const double kept = static_cast<double>(target) / static_cast<double>(std::max<std::size_t>(1, samples));
        nearest_ = 0.65 * (1.0 - std::pow(kept, 1.5));
    }

    double operator()(double squared_distance) const {
        const double distance = std::max(nearest_, std::sqrt(squared_distance) / reach_);
        const double nearness = std::max(0.0, 1.0 - distance);
        const double power2 = nearness * nearness;
        const double power4 = power2 * power2;
        return power4 * power4;
    }

  private:
    double reach_;
    double nearest_;  ///< in units of the reach
};

struct HeapEntry {
    double weight;
    std::size_t sample;

    /// Order of a max-heap whose top is the most crowded sample, of equals the one with the lowest index.
    bool operator<(const HeapEntry& other) const {
        return weight != other.weight ? weight < other.weight : sample > other.sample;
    }
};

}  // namespace

double packing_radius(double volume, std::size_t count) {
    return std::cbrt(volume / (4.0 * std::sqrt(2.0) * static_cast<double>(count)));
}

std::vector<std::size_t> eliminate_samples(const std::vector<openvdb::Vec3d>& samples, std::size_t target, double r_max) {
    const double reach = 2.0 * r_max;
    const Crowding crowding(samples.size(), target, reach);
    const PointGrid grid(samples, reach);
    std::vector<double> weight(samples.size(), 0.0);
    tbb::parallel_for(std::size_t(0), samples.size(), [&](std::size_t n) {
        grid.for_each_within(samples[n], reach, [&](std::size_t other, double squared_distance) {
            if (other != n) weight[n] += crowding(squared_distance);
        });
    });

    std::vector<HeapEntry> heap(samples.size());
    for (std::size_t n = 0; n < samples.size(); ++n) heap[n] = {weight[n], n};
    std::make_heap(heap.begin(), heap.end());
    std::vector<bool> alive(samples.size(), true);
    for (std::size_t left = samples.size(); left > target;) {
        std::pop_heap(heap.begin(), heap.end());
        HeapEntry& top = heap.back();
        const std::size_t sample = top.sample;
        if (top.weight != weight[sample]) {
            // Weights only fall: a stale entry stands too high and goes back to where it belongs now.
            top.weight = weight[sample];
            std::push_heap(heap.begin(), heap.end());
            continue;
        }
        heap.pop_back();
        alive[sample] = false;
        grid.for_each_within(samples[sample], reach, [&](std::size_t other, double squared_distance) {
            if (alive[other]) weight[other] -= crowding(squared_distance);
        });
        if (--left % 4096 == 0) throw_if_interrupted();
    }

    std::vector<std::size_t> survivors;
    survivors.reserve(target);
    for (std::size_t n = 0; n < samples.size(); ++n)
        if (alive[n]) survivors.push_back(n);
    return survivors;
}

}  // namespace opal
