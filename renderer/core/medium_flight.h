// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/exponential.h"
#include "renderer/core/medium.h"
#include "renderer/core/scene_view.h"

namespace opal {

/// One straight flight through the opal's body, followed piece by piece. Absorption goes into the throughput, whose hero it never
/// ends; every lane's probability of what happened goes into its ratio.
///
/// Where no coefficient varies everything has a closed form. Else the flight goes from cell to cell of the majorant grid, and in
/// each cell every coefficient is split into its minimum there and a rest (residual tracking: Novak, Selle & Jarosz 2014; Kutz et
/// al. 2017). With a, r, m the fields (absorption scale, Rayleigh, Mie), a0, r0, m0 their minima in the cell, a1, r1, m1 their
/// maxima, and A, R, M what lane i multiplies them with:
///   c_i = r0 R + m0 M              scattering of the cell's minimum: a closed form
///   a0 A                           absorption of the cell's minimum: a closed form
///   s_i(x) = (r - r0) R + (m - m0) M,  q_i(x) = (a - a0) A     the rests
///   mu = (a1 - a0) max A + (r1 - r0) max R + (m1 - m0) max M   majorant of s_i + q_i, shared by the lanes
/// A path is a sequence of tentative collisions. For lane i a flight of length t without one has probability exp(-(c_i + mu) t),
/// and a collision has the density c_i (scattering by the minimum), s_i (scattering by the rest) or mu - s_i (null: nothing
/// happens). Their sum is c_i + mu: the lane's own sampling (Woodcock et al. 1965). What light physically does has the terms
/// exp(-(c_i + a0 A + mu) t), c_i, s_i and mu - s_i - q_i over the same sequences, since null collisions that keep all light
/// change nothing (integral form: Miller, Georgiev & Jarosz 2019). So per lane, physical over own density
///   flight: exp(-a0 A t),   scattering: 1,   null: 1 - q_i / (mu - s_i)
/// goes into the throughput (ratio tracking of the absorption), and own density over the hero's
///   flight: exp((c_0 - c_i) t),   scattering: c_i / c_0 or s_i / s_0 (scatter_direction),   null: (mu - s_i) / (mu - s_0)
/// into the ratio. Nothing is cut off: the expected value is exact for any majorant that is one. Between the pieces of a flight
/// only the optical depth to the next collision is kept.
template <int N>
class MediumFlight {
  public:
    /// Begins at `ray`'s origin (world). `weights`: the lanes that still count. Tentative collisions where a field exceeds its
    /// bounds are added to `majorant_violations`.
    OPAL_HD MediumFlight(const OpalView& opal, const LaneMedium<N>& medium, const Ray& ray, const LaneWeights<N>& weights,
                         PathRandom& random, uint64_t& majorant_violations)
        : view_(opal.medium), medium_(medium), random_(random), majorant_violations_(majorant_violations) {
        if (varies()) {
            begin_in_fields(opal.world_from_object, ray, weights);
            return;
        }
        const real sigma_s = medium.sigma_s(0);
        scatter_mm_ = sigma_s > 0.0f ? free_depth(random.next()) / sigma_s : 3.0e38f;
    }

    /// Goes on to `distance_mm` from the flight's start, or to where the hero scatters before that. Returns the distance reached.
    OPAL_HD real advance(real distance_mm, LaneWeights<N>& weights) {
        if (varies()) return advance_in_fields(distance_mm, weights);
        const real end_mm = min_of(distance_mm, scatter_mm_);
        const real step_mm = end_mm - reached_mm_;
        pass(step_mm, weights);
        reached_mm_ = end_mm;
        return end_mm;
    }

    /// In closed form: begins anew after light has gone `path_mm` on other ways, not so far that it scatters.
    OPAL_HD void begin_again(real path_mm, LaneWeights<N>& weights) {
        pass(path_mm, weights);
        scatter_mm_ -= path_mm;
    }

    /// Whether nothing varies: then the flight need not be straight.
    OPAL_HD bool closed_form() const { return !varies(); }
    /// Of a flight in closed form: where it scatters.
    OPAL_HD real scatter_distance_mm() const { return scatter_mm_; }

    /// Whether the flight ended by scattering at the distance that `advance` returned.
    OPAL_HD bool scattered() const { return reached_mm_ == scatter_mm_; }

    /// What the hero scattered by, and the lanes'.
    OPAL_HD const LaneMedium<N>& local() const { return varies() ? local_ : medium_; }

  private:
    OPAL_HD void pass(real length_mm, LaneWeights<N>& weights) const {
        OPAL_SIMD
        for (int i = 0; i < N; ++i) weights.throughput.v[i] *= exponential(-medium_.sigma_a.v[i] * length_mm);
        OPAL_SIMD
        for (int i = 1; i < N; ++i) weights.ratio.v[i] *= exponential((medium_.sigma_s(0) - medium_.sigma_s(i)) * length_mm);
    }

    /// Throughput below which a null collision halves the chance to go on: a flight through a deep absorber would otherwise
    /// compute what is too faint to matter.
    static constexpr real faint = 0x1p-10f;

    OPAL_HD bool varies() const { return view_.majorants.cells != nullptr; }
    OPAL_HD real draw_depth() { return free_depth(random_.next()); }

    OPAL_HD void begin_in_fields(const RigidTransform& world_from_object, const Ray& ray, const LaneWeights<N>& weights) {
        origin_mm_ = world_from_object.local_from_world_point(ray.origin);
        step_mm_ = (1.0f / world_from_object.scale) * world_from_object.local_from_world_direction(ray.direction);
        walk_.start(view_.majorants, origin_mm_, step_mm_);
        scatter_mm_ = 3.0e38f;
        depth_ = draw_depth();
        for (real& strongest : strongest_) strongest = 0.0f;
        // A lane that could not have come here decides nothing, whichever lane is the hero.
        for (int i = 0; i < weights.count; ++i) {
            if (weights.ratio.v[i] == 0.0f) continue;
            strongest_[0] = max_of(strongest_[0], medium_.sigma_a.v[i]);
            strongest_[1] = max_of(strongest_[1], medium_.sigma_rayleigh.v[i]);
            strongest_[2] = max_of(strongest_[2], medium_.sigma_mie.v[i]);
        }
    }

    OPAL_HD real advance_in_fields(real distance_mm, LaneWeights<N>& weights) {
        real minima[num_medium_fields] = {};  // integrated over the way
        while (!scattered() && !extinct_ && reached_mm_ < distance_mm) {
            const MajorantCell& cell = walk_.cell();
            const real exit_mm = walk_.exit();
            const real end_mm = max_of(reached_mm_, min_of(distance_mm, exit_mm));
            const real base_per_mm = cell.min[1] * medium_.sigma_rayleigh.v[0] + cell.min[2] * medium_.sigma_mie.v[0];
            real rest_per_mm = 0.0f;
            for (int f = 0; f < num_medium_fields; ++f) rest_per_mm += (cell.max[f] - cell.min[f]) * strongest_[f];
            const real total_per_mm = base_per_mm + rest_per_mm;
            real length_mm = end_mm - reached_mm_;
            const bool collides = total_per_mm * length_mm > depth_;
            if (collides) length_mm = depth_ / total_per_mm;
            for (int f = 0; f < num_medium_fields; ++f) minima[f] += cell.min[f] * length_mm;
            if (collides) {
                reached_mm_ = min_of(reached_mm_ + length_mm, end_mm);
                depth_ = draw_depth();
                collide(cell, base_per_mm, rest_per_mm, weights);
            } else {
                reached_mm_ = end_mm;
                depth_ -= total_per_mm * length_mm;
                if (end_mm == exit_mm) walk_.step();
            }
        }
        if (extinct_) reached_mm_ = max_of(reached_mm_, distance_mm);
        pass_minima(minima, weights);
        return reached_mm_;
    }

    OPAL_HD void pass_minima(const real* minima, LaneWeights<N>& weights) const {
        if (minima[0] > 0.0f)
            for (int i = 0; i < weights.count; ++i) weights.throughput.v[i] *= exp(-medium_.sigma_a.v[i] * minima[0]);
        if (minima[1] > 0.0f || minima[2] > 0.0f)
            for (int i = 1; i < weights.count; ++i)
                weights.ratio.v[i] *= exp((medium_.sigma_rayleigh.v[0] - medium_.sigma_rayleigh.v[i]) * minima[1] +
                                          (medium_.sigma_mie.v[0] - medium_.sigma_mie.v[i]) * minima[2]);
    }

    OPAL_HD void collide(const MajorantCell& cell, real base_per_mm, real rest_per_mm, LaneWeights<N>& weights) {
        if (base_per_mm > 0.0f && random_.next() * (base_per_mm + rest_per_mm) < base_per_mm)
            return scatter(cell.min[1], cell.min[2]);
        const Vec3 place_mm = origin_mm_ + reached_mm_ * step_mm_;
        real rest[num_medium_fields];
        for (int f = 0; f < num_medium_fields; ++f) {
            // One density may stand for several coefficients: then one look is enough.
            const bool same = f > 0 && view_.fields[f].grid == view_.fields[0].grid;
            rest[f] = same ? rest[0] : cell.max[f] > cell.min[f] ? rest_of(f, cell, place_mm) : 0.0f;
        }
        const real hero_per_mm = rest[1] * medium_.sigma_rayleigh.v[0] + rest[2] * medium_.sigma_mie.v[0];
        if (random_.next() * rest_per_mm < hero_per_mm) return scatter(rest[1], rest[2]);
        real largest = 0.0f;
        for (int i = 0; i < N && i < weights.count; ++i) {
            const real scattered_per_mm = rest[1] * medium_.sigma_rayleigh.v[i] + rest[2] * medium_.sigma_mie.v[i];
            const real null_per_mm = max_of(0.0f, rest_per_mm - scattered_per_mm);
            const real kept_per_mm = max_of(0.0f, null_per_mm - rest[0] * medium_.sigma_a.v[i]);
            weights.throughput.v[i] *= null_per_mm > 0.0f ? kept_per_mm / null_per_mm : 0.0f;
            if (i > 0) weights.ratio.v[i] *= null_per_mm / (rest_per_mm - hero_per_mm);
            largest = max_of(largest, weights.throughput.v[i]);
        }
        if (largest < faint) thin_out(largest, weights);
    }

    /// By the largest throughput of any lane: the same for every choice of the hero, so the lanes' ratios stay.
    OPAL_HD void thin_out(real largest, LaneWeights<N>& weights) {
        const bool goes_on = largest > 0.0f && random_.next() < 0.5f;
        for (int i = 0; i < weights.count; ++i) weights.throughput.v[i] *= goes_on ? 2.0f : 0.0f;
        extinct_ = !goes_on;
    }

    OPAL_HD void scatter(real rayleigh, real mie) {
        for (int i = 0; i < N; ++i) {
            local_.sigma_rayleigh.v[i] = rayleigh * medium_.sigma_rayleigh.v[i];
            local_.sigma_mie.v[i] = mie * medium_.sigma_mie.v[i];
        }
        scatter_mm_ = reached_mm_;
    }

    /// What a field has above its minimum in the cell. Rounding may carry it past the bounds by a few units in the last place;
    /// more is a violation.
    OPAL_HD real rest_of(int field, const MajorantCell& cell, Vec3 place_mm) {
        const real low = cell.min[field], high = cell.max[field];
        const real value = field_value(view_.fields[field], place_mm);
        const real rounding = 1.0e-5f * high;
        if (!(value >= low - rounding && value <= high + rounding)) ++majorant_violations_;
        return min_of(max_of(value, low), high) - low;
    }

    const MediumView& view_;
    const LaneMedium<N>& medium_;
    PathRandom& random_;
    uint64_t& majorant_violations_;
    real scatter_mm_;  ///< where it scatters; in fields known only once it has
    real reached_mm_ = 0.0f;
    // In fields alone.
    real depth_;  ///< optical depth left to the next tentative collision
    bool extinct_ = false;
    real strongest_[num_medium_fields];  ///< of the lanes, per unit of each field
    Vec3 origin_mm_, step_mm_;           ///< object space; the step is per world mm
    MajorantWalk walk_;
    LaneMedium<N> local_;
};

}  // namespace opal
