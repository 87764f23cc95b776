// SPDX-License-Identifier: Apache-2.0
#include "cell_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opal {
namespace {

using Real = long double;
using Place = std::array<Real, 3>;

struct ExactRay {
    Place origin, direction;

    ExactRay(Vec3 o, Vec3 v) : origin{o.x, o.y, o.z}, direction{v.x, v.y, v.z} {
        const Real norm = std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
        for (Real& component : direction) component /= norm;
    }
};

/// A site's distance from a place of the ray, how fast that changes along it, and delta.
struct Nearness {
    Real distance, slope, delta;

    Nearness(const Site& site, const ExactRay& ray, Real at) {
        Real square = 0.0L, along = 0.0L;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Real offset = ray.origin[axis] + at * ray.direction[axis] - Real(site.position_mm[int(axis)]);
            square += offset * offset;
            along += offset * ray.direction[axis];
        }
        distance = std::sqrt(square);
        slope = distance > 0.0L ? along / distance : 0.0L;
        delta = distance - Real(site.weight_mm);
    }
};

class Subdivision {
  public:
    Subdivision(const std::vector<Site>& sites, const ExactRay& ray) : sites_(sites), ray_(ray) {}

    void divide(const std::vector<std::int32_t>& from, Real begin, Real end) {
        const Real middle = 0.5L * (begin + end), half = 0.5L * (end - begin);
        std::vector<Nearness> nearness;
        std::size_t nearest = 0;
        for (const std::int32_t site : from) {
            nearness.emplace_back(sites_[std::size_t(site)], ray_, middle);
            if (nearness.back().delta < nearness[nearest].delta) nearest = nearness.size() - 1;
        }
        const Nearness& best = nearness[nearest];
        const int grain = sites_[std::size_t(from[nearest])].grain;
        std::vector<std::int32_t> kept;
        bool one_grain = true;
        for (std::size_t n = 0; n < from.size(); ++n) {
            if (n != nearest && !can_win(nearness[n], best, half)) continue;
            kept.push_back(from[n]);
            one_grain = one_grain && sites_[std::size_t(from[n])].grain == grain;
        }
        if (one_grain || half < 0.5e-9L) {
            if (stretches.empty() || stretches.back().grain != grain) stretches.push_back({grain, double(begin)});
            return;
        }
        divide(kept, begin, middle);
        divide(kept, middle, end);
    }

    std::vector<GrainStretch> stretches;

  private:
    /// Whether `other` may be nearer than `best` somewhere within `half` of the middle. The first bound takes each delta to be
    /// 1-Lipschitz; the second its second derivative, which is at most one over the distance.
    static bool can_win(const Nearness& other, const Nearness& best, Real half) {
        const Real behind = other.delta - best.delta;
        if (behind > 2.0L * half) return false;
        if (best.distance <= 2.0L * half) return true;
        // best.delta rises by at most slope t + t^2 / (2 (r - half)); other.delta, which is convex, by at least slope t.
        const Real slope = std::abs(other.slope - best.slope);
        return behind <= slope * half + half * half / (2.0L * (best.distance - half));
    }

    const std::vector<Site>& sites_;
    const ExactRay& ray_;
};

int grain_at(const std::vector<GrainStretch>& stretches, double at_mm) {
    int grain = 0;
    for (const GrainStretch& stretch : stretches) {
        if (stretch.begin_mm > at_mm) break;
        grain = stretch.grain;
    }
    return grain;
}

/// Pairs changes between the same grains, in order and no farther apart than `match_mm`; returns how many of `a` have none.
std::uint64_t unmatched(const std::vector<GrainStretch>& a, const std::vector<GrainStretch>& b, double match_mm,
                        WalkErrors* errors) {
    std::uint64_t missing = 0;
    for (std::size_t n = 1; n < a.size(); ++n) {
        double nearest_mm = 2.0 * match_mm;
        for (std::size_t m = 1; m < b.size(); ++m)
            if (b[m].grain == a[n].grain && b[m - 1].grain == a[n - 1].grain)
                nearest_mm = std::min(nearest_mm, std::abs(b[m].begin_mm - a[n].begin_mm));
        if (nearest_mm > match_mm) {
            ++missing;
        } else if (errors) {
            errors->largest_error_mm = std::max(errors->largest_error_mm, nearest_mm);
            errors->error_sum_mm += nearest_mm;
        }
    }
    return missing;
}

}  // namespace

std::vector<GrainStretch> exact_stretches(const std::vector<Site>& sites, Vec3 origin, Vec3 direction, double end_mm) {
    const ExactRay ray(origin, direction);
    std::vector<std::int32_t> all;
    for (std::size_t n = 0; n < sites.size(); ++n)
        if (sites[n].grain != 0) all.push_back(std::int32_t(n));
    Subdivision subdivision(sites, ray);
    subdivision.divide(all, 0.0L, Real(end_mm));
    return subdivision.stretches;
}

double excess_mm(const std::vector<Site>& sites, Vec3 origin, Vec3 direction, double at_mm, int grain) {
    const ExactRay ray(origin, direction);
    Real nearest = 1.0e30L, nearest_of_grain = 1.0e30L;
    for (const Site& site : sites) {
        if (site.grain == 0) continue;
        const Real delta = Nearness(site, ray, Real(at_mm)).delta;
        nearest = std::min(nearest, delta);
        if (site.grain == grain) nearest_of_grain = std::min(nearest_of_grain, delta);
    }
    return double(nearest_of_grain - nearest);
}

void add_errors(const std::vector<Site>& sites, Vec3 origin, Vec3 direction, double end_mm,
                const std::vector<GrainStretch>& exact, const std::vector<GrainStretch>& walked, double match_mm,
                WalkErrors& errors) {
    errors.crossings += exact.size() - 1;
    errors.missed += unmatched(exact, walked, match_mm, &errors);
    errors.spurious += unmatched(walked, exact, match_mm, nullptr);
    errors.length_mm += end_mm;
    std::vector<double> cuts = {0.0, end_mm};
    for (const std::vector<GrainStretch>* stretches : {&exact, &walked})
        for (const GrainStretch& stretch : *stretches) cuts.push_back(stretch.begin_mm);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t n = 0; n + 1 < cuts.size(); ++n) {
        const double middle_mm = 0.5 * (cuts[n] + cuts[n + 1]);
        const int grain = grain_at(walked, middle_mm);
        if (cuts[n + 1] <= cuts[n] || grain == grain_at(exact, middle_mm)) continue;
        errors.wrong_mm += cuts[n + 1] - cuts[n];
        // A walk that has not begun yet (voxels cut by the surface) is in no grain.
        if (grain != 0)
            errors.largest_excess_mm = std::max(errors.largest_excess_mm, excess_mm(sites, origin, direction, middle_mm, grain));
    }
}

}  // namespace opal
