// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/beam_exchange.h"
#include "renderer/core/ewald_turn.h"
#include "renderer/core/grain_visit.h"
#include "renderer/core/guided_scattering.h"
#include "renderer/core/medium_flight.h"

/// Transport inside the opal: grains met one after another, each with its planes; scattering and absorption on the way.
namespace opal {

/// Counts that a render reports.
struct PathCounters {
    uint64_t diffractions = 0;  ///< turns by lattice planes
    uint64_t turns_back = 0;    ///< of them, by the planes that had just turned the light
    uint64_t scatterings = 0;
    uint64_t grain_crossings = 0;   ///< stays in a grain
    uint64_t multi_beam_stays = 0;  ///< begun in a direction along which two or more families reflect more than half each
    uint64_t lost_paths = 0;        ///< left the opal through a gap of its surface
    uint64_t truncated_paths = 0;
    uint64_t not_a_number = 0;
    uint64_t majorant_violations = 0;  ///< tentative collisions where a field exceeds its bounds

    OPAL_HD void add(const PathCounters& other) {
        diffractions += other.diffractions;
        turns_back += other.turns_back;
        scatterings += other.scatterings;
        grain_crossings += other.grain_crossings;
        multi_beam_stays += other.multi_beam_stays;
        lost_paths += other.lost_paths;
        truncated_paths += other.truncated_paths;
        not_a_number += other.not_a_number;
        majorant_violations += other.majorant_violations;
    }
};

enum class InteriorEventKind { surface, diffraction, scattering };

struct InteriorEvent {
    InteriorEventKind kind = InteriorEventKind::surface;
    Vec3 position;  ///< world mm
    Vec3 direction;
    bool turned_back = false;  ///< into one of the two directions that the light goes back and forth between
};

/// Two-beam theory speaks of one strong family at a time.
template <int N>
OPAL_HD inline bool is_multi_beam(const OpalView& opal, const GrainVisit<N>& visit) {
    const real half_per_mm = visit.max_rate_per_mm / (opal.max_odds + 1.0f);  // odds 1 over the grain's size, saturated
    int strong = 0;
    for (int i = 0; i < visit.present().count; ++i) strong += visit.present().rate_per_mm[0][i] > half_per_mm ? 1 : 0;
    return strong > 1;
}

/// Makes sure that the rates along the present flight are known; begins a stay where there is none.
template <int N>
OPAL_HD inline void prepare_visit(const OpalView& opal, const LaneOptics<N>& optics, Vec3 direction, GrainVisit<N>& visit,
                                  PathRandom& random, PathCounters& counters) {
    const bool begins = visit.fresh;
    if (begins) begin_visit(opal, visit, random);
    if (visit.present_known) return;
    const Vec3 object_direction = opal.world_from_object.local_from_world_direction(direction);
    const Vec3 lattice_direction = visit.object_from_lattice.conjugate().rotate(object_direction);
    evaluate_rates(opal, optics, visit, direction, lattice_direction, visit.rates[visit.current]);
    visit.present_known = true;
    if (!begins) return;
    ++counters.grain_crossings;
    if (is_multi_beam(opal, visit)) ++counters.multi_beam_stays;
}

/// Every lane's probability of flying `length_mm` without a turn, over the hero's.
template <int N>
OPAL_HD inline void pass_planes(const GrainRates<N>& rates, real length_mm, LaneWeights<N>& weights) {
    OPAL_SIMD
    for (int i = 1; i < N; ++i) weights.ratio.v[i] *= exponential((rates.total_per_mm[0] - rates.total_per_mm[i]) * length_mm);
}

/// Every lane's probability of being turned by a family (index into the rates), over the hero's.
template <int N>
OPAL_HD inline void take_turn(const GrainRates<N>& rates, int family, LaneWeights<N>& weights) {
    for (int i = 1; i < weights.count; ++i) weights.ratio.v[i] *= rates.rate_per_mm[i][family] / rates.rate_per_mm[0][family];
}

/// The Ewald rule at the boundary where a stay begins. Returns whether the hero is turned, with its new direction (world).
template <int N>
OPAL_HD inline bool turn_at_boundary(const OpalView& opal, const LaneOptics<N>& optics, Vec3 direction, Vec3 object_direction,
                                     GrainVisit<N>& visit, LaneWeights<N>& weights, PathRandom& random, Vec3& turned) {
    visit.at_boundary = false;
    const Vec3 lattice_direction = visit.object_from_lattice.conjugate().rotate(object_direction);
    const real u = random.next();
    const EwaldChance hero = ewald_chance(opal, optics, 0, lattice_direction, u);
    if (hero.pair < 0) {
        for (int i = 1; i < weights.count; ++i)
            weights.ratio.v[i] *= (1.0f - ewald_chance(opal, optics, i, lattice_direction, u).probability) /
                                  max_of(1.0e-7f, 1.0f - hero.probability);
        return false;
    }
    // The direction depends on the wavelength.
    weights.drop_companions();
    const PlanePair& pair = opal.pairs[hero.pair];
    const Vec3 normal = opal.world_from_object.world_from_local_direction(visit.object_from_lattice.rotate(pair.normal));
    turned = ewald_direction(direction, normal, pair.g_per_nm, optics.wavelength_nm[0] / optics.n_eff[0]);
    visit.renew();
    return true;
}

/// No surface lies nearer (world mm) to a place inside the opal (object mm): its depth by the level set, less a voxel for what
/// the triangles may deviate from it.
OPAL_HD inline real clearance_mm(const OpalView& opal, Vec3 place) {
    if (!opal.shape.grid) return 0.0f;
    const real depth_mm = -field_value(opal.shape, place);
    return max_of(0.0f, depth_mm - 1.0f / opal.shape.voxels_per_mm) * opal.world_from_object.scale;
}

/// Makes the event, whose position is known and whose direction is that before, a scattering.
template <int N>
OPAL_HD inline void scatter(const OpalView& opal, const PathWavelengths<N>& wavelengths, const LaneMedium<N>& medium,
                            GrainVisit<N>& visit, LaneWeights<N>& weights, PathRandom& random, PathCounters& counters,
                            InteriorEvent& event) {
    ++counters.scatterings;
    event.kind = InteriorEventKind::scattering;
    event.turned_back = false;
    const bool guided = opal.guide.weight && weights.guided_scatterings < most_guided_scatterings;
    event.direction = guided ? guided_scatter_direction(opal.medium, opal.guide, event.position, wavelengths, medium,
                                                        event.direction, weights, random)
                             : scatter_direction(opal.medium, wavelengths, medium, event.direction, weights, random);
    visit.renew();
}

/// Fewer flights than these between a place and the surface are not worth an exchange; with more than these one need not know
/// better how far the surface is.
inline constexpr real exchange_min_flights = 0.5f, exchange_many_flights = 8.0f;

/// Lets the light go back and forth between two beams from the ray's origin. Returns whether that ended by an event, to which it
/// has brought `event`; else `ray` is moved to the beginning of `next`, the flight that may leave the grain or the body.
/// `clear_known`: `visit.clear_mm` is as good as it gets where the ray then begins.
template <int N>
OPAL_HD inline bool exchange_in_grain(const OpalView& opal, const PathWavelengths<N>& wavelengths, const LaneMedium<N>& medium,
                                      Ray& ray, MediumFlight<N>& flight, GrainVisit<N>& visit, LaneWeights<N>& weights,
                                      PathRandom& random, PathCounters& counters, PlannedTurn& next, InteriorEvent& event,
                                      bool& clear_known) {
    const RigidTransform& world_from_object = opal.world_from_object;
    const real object_per_world = 1.0f / world_from_object.scale;
    const real flights_per_mm = visit.present().total_per_mm[0];
    const Vec3 place = world_from_object.local_from_world_point(ray.origin);
    if (visit.clear_mm * flights_per_mm < exchange_many_flights) {
        visit.clear_mm = max_of(visit.clear_mm, clearance_mm(opal, place));
        clear_known = true;
    }
    if (visit.clear_mm * flights_per_mm < exchange_min_flights) return false;
    ExchangeRegion region(world_from_object.local_from_world_direction(visit.present().direction),
                          world_from_object.local_from_world_direction(visit.rates[1 - visit.current].direction));
    keep_in_grain(opal.grains, place, visit.grain, visit.cell, opal.grain_size_mm[visit.grain - 1], region);
    region.keep_in_ball(visit.clear_mm * object_per_world);
    const BeamExchange exchange = exchange_beams(visit, region, object_per_world, flight.scatter_distance_mm(), random);
    next = exchange.next;
    const real path_mm = exchange.path_mm();
    const uint64_t turns = uint64_t(exchange.turns[0] + exchange.turns[1]);
    if (turns == 0 && path_mm == 0.0f) return false;
    clear_known = false;
    weigh_exchange(visit, exchange, weights);
    counters.diffractions += turns;
    counters.turns_back += turns;
    const Vec3 offset = exchange.flown_mm[0] * visit.rates[0].direction + exchange.flown_mm[1] * visit.rates[1].direction;
    visit.clear_mm = max_of(0.0f, visit.clear_mm - length(offset));
    ray = {ray.origin + offset, visit.present().direction};
    flight.begin_again(path_mm, weights);
    if (!exchange.scattered && exchange.turned_by < 0) return false;
    event = {InteriorEventKind::diffraction, ray.origin, ray.direction, false};
    if (exchange.scattered) {
        scatter(opal, wavelengths, medium, visit, weights, random, counters, event);
    } else {
        ++counters.diffractions;
        take_turn(visit.present(), exchange.turned_by, weights);
        event.direction = turn_visit(opal, visit, visit.present().pair[exchange.turned_by]);
    }
    return true;
}

/// Follows `ray` (world, inside the opal) until planes turn it, it scatters or reaches the surface; `ray` is then the last of the
/// straight flights on the way. `surface.distance_mm()` finds the surface ahead of it with a ray cast, no longer than it has to
/// be; it is asked only where the ray might get so far: inside a band the next turn is often some micrometres away.
template <int N, class SurfaceProbe>
OPAL_HD inline InteriorEvent cross_interior(const OpalView& opal, const PathWavelengths<N>& wavelengths,
                                            const LaneOptics<N>& optics, const LaneMedium<N>& medium, Ray& ray,
                                            SurfaceProbe& surface, GrainVisit<N>& visit, LaneWeights<N>& weights,
                                            PathRandom& random, PathCounters& counters) {
    MediumFlight<N> flight(opal, medium, ray, weights, random, counters.majorant_violations);
    InteriorEvent event{InteriorEventKind::surface, ray.origin, ray.direction, false};
    if (opal.diffraction != Diffraction::none && opal.num_pairs > 0) {
        const real scale = opal.world_from_object.scale;
        PlannedTurn planned;
        bool clear_known = false;
        if (visit.grain != 0 && !visit.fresh && visit.link >= 0 && flight.closed_form()) {
            prepare_visit(opal, optics, ray.direction, visit, random, counters);
            if (exchanges_beams(visit) && exchange_in_grain(opal, wavelengths, medium, ray, flight, visit, weights, random,
                                                            counters, planned, event, clear_known))
                return event;
        }
        const Vec3 direction = opal.world_from_object.local_from_world_direction(ray.direction);
        const Vec3 origin = opal.world_from_object.local_from_world_point(ray.origin);
        GrainPath walk(opal.grains, origin, direction, visit.cell);
        real reached = 0.0f;  // object mm, like everything on the walk
        real entered_mm = 0.0f;
        if (visit.grain == 0) {
            visit.enter(walk.next_grain(0, reached, surface.distance_mm() / scale));
            visit.cell = walk.cell();
        }
        real clear_mm = visit.clear_mm;  // no surface within this distance of the origin
        while (visit.grain != 0) {
            prepare_visit(opal, optics, ray.direction, visit, random, counters);
            Vec3 turned;
            if (opal.diffraction == Diffraction::ewald_fresnel && visit.at_boundary &&
                turn_at_boundary(opal, optics, ray.direction, direction, visit, weights, random, turned)) {
                ++counters.diffractions;
                return {InteriorEventKind::diffraction, ray.origin + entered_mm * ray.direction, turned, false};
            }
            const GrainRates<N>& rates = visit.present();
            const real total_per_mm = rates.total_per_mm[0];
            real turn_mm = 3.0e38f;
            if (planned.family >= 0)
                turn_mm = planned.length_mm;
            else if (total_per_mm > 0.0f)
                turn_mm = entered_mm + free_depth(random.next()) / total_per_mm;
            real surface_mm = 3.0e38f;
            // As far as surely no surface is; then as far as there may be one.
            int next = 0;
            if (clear_mm > entered_mm) next = walk.next_grain(visit.grain, reached, min_of(clear_mm, turn_mm) / scale);
            if (next == 0 && turn_mm > clear_mm && !clear_known) {
                clear_mm = max_of(clear_mm, clearance_mm(opal, origin));
                clear_known = true;
                if (clear_mm > max_of(entered_mm, reached * scale))
                    next = walk.next_grain(visit.grain, reached, min_of(clear_mm, turn_mm) / scale);
            }
            if (next == 0 && turn_mm > clear_mm) {
                // A turn or a scattering far before the grain's other side mostly is what comes next.
                const real event_mm = min_of(turn_mm, flight.scatter_distance_mm());
                const real near_mm = entered_mm + scale * opal.grain_size_mm[visit.grain - 1];
                surface_mm = event_mm < near_mm ? surface.distance_mm(event_mm) : surface.distance_mm();
                // Never beyond the event: where no surface is known, voxels go on without end.
                next = walk.next_grain(visit.grain, reached, min_of(surface_mm, event_mm) / scale);
            }
            visit.cell = walk.cell();
            const real leaves_mm = next == 0 ? surface_mm : max_of(entered_mm, reached * scale);
            const real end_mm = min_of(min_of(turn_mm, leaves_mm), surface_mm);
            const real passed_mm = flight.advance(end_mm, weights);
            pass_planes(rates, passed_mm - entered_mm, weights);
            if (flight.scattered()) break;
            if (turn_mm <= end_mm) {
                const int family = planned.family >= 0 ? planned.family : choose_family(rates, random.next() * total_per_mm);
                take_turn(rates, family, weights);
                const int k = rates.pair[family];
                const bool turned_back = k == visit.link;
                ++counters.diffractions;
                if (turned_back) ++counters.turns_back;
                visit.clear_mm = max_of(0.0f, clear_mm - turn_mm);
                return {InteriorEventKind::diffraction, ray.origin + turn_mm * ray.direction, turn_visit(opal, visit, k),
                        turned_back};
            }
            if (next == 0 || end_mm >= surface_mm) break;
            visit.enter(next);
            planned.family = -1;
            entered_mm = end_mm;
        }
    }
    // Where it scattered in the grains, it goes no farther.
    const real end_mm = flight.scattered() ? flight.scatter_distance_mm() : surface.distance_mm();
    event.position = ray.origin + flight.advance(end_mm, weights) * ray.direction;
    event.direction = ray.direction;
    if (flight.scattered()) scatter(opal, wavelengths, flight.local(), visit, weights, random, counters, event);
    return event;
}

}  // namespace opal
