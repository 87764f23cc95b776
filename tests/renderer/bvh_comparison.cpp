// SPDX-License-Identifier: Apache-2.0
#include "bvh_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/random.h"
#include "renderer/host/patch_surface.h"
#include "renderer/host/piece_bounds.h"
#include "round_body.h"

namespace opal {
namespace {

/// Numbers of one ray or triangle, one after another.
class Numbers {
  public:
    Numbers(std::uint64_t seed, std::uint64_t index) : seed_(seed), index_(index) {}

    float next() {
        if (used_ == 4) {
            block_ = random_block(seed_, RandomStream::bench, index_, number_++);
            used_ = 0;
        }
        return uniform_float(block_.value[used_++]);
    }
    std::size_t below(std::size_t count) { return std::min(count - 1, std::size_t(next() * float(count))); }
    Vec3 direction() {
        const float z = 2.0f * next() - 1.0f, angle_rad = 2.0f * pi_f * next(), r = std::sqrt(1.0f - z * z);
        return normalize({r * std::cos(angle_rad), r * std::sin(angle_rad), z});
    }
    Vec3 in_ball(float radius_mm) { return radius_mm * std::cbrt(next()) * direction(); }

  private:
    std::uint64_t seed_, index_;
    std::uint32_t number_ = 0;
    int used_ = 4;
    RandomBlock block_{};
};

MeshData triangle_soup(int triangles, float radius_mm) {
    MeshData mesh;
    for (int i = 0; i < triangles; ++i) {
        Numbers numbers(21, std::uint64_t(i));
        const Vec3 middle = numbers.in_ball(radius_mm);
        const float size_mm = 2.0f * std::pow(10.0f, -3.0f * numbers.next());
        for (int corner = 0; corner < 3; ++corner) {
            mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
            mesh.positions.push_back(middle + size_mm * numbers.direction());
        }
    }
    return mesh;
}

/// A dome on a flat base.
MeshData cabochon() {
    MeshData mesh = make_sphere(5.0);
    mesh.normals.clear();
    for (Vec3& p : mesh.positions) p.z = 0.6f * std::max(0.0f, p.z) - 1.0f;
    return mesh;
}

/// Triangles of a mesh dealt out to several, which then share all their edges.
std::vector<MeshData> dealt_out(const MeshData& mesh, std::size_t count) {
    std::vector<MeshData> parts(count);
    for (MeshData& part : parts) part.positions = mesh.positions;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) parts[i / 3 % count].indices.push_back(mesh.indices[i]);
    return parts;
}

std::vector<MeshData> cube(int cells, float half_mm) {
    std::vector<MeshData> faces;
    for (int face = 0; face < 6; ++face) {
        MeshData mesh;
        const float side = face % 2 == 0 ? half_mm : -half_mm;
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i) {
                const float a = half_mm * float(2 * i - cells) / float(cells), b = half_mm * float(2 * j - cells) / float(cells);
                mesh.positions.push_back(face / 2 == 0 ? Vec3{side, a, b}
                                                       : (face / 2 == 1 ? Vec3{a, side, b} : Vec3{a, b, side}));
            }
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const auto corner = [&](int x, int y) { return std::uint32_t((j + y) * (cells + 1) + i + x); };
                for (const std::uint32_t k : {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0), corner(1, 1), corner(0, 1)})
                    mesh.indices.push_back(k);
            }
        faces.push_back(std::move(mesh));
    }
    return faces;
}

std::vector<MeshData> exact_bodies() {
    std::vector<BezierPatch> patches = round_body(3.0, 2.0, 1.0);
    const std::vector<BezierPatch> other = round_body(1.0, 1.5, 1.2, 2.0, 1);
    patches.insert(patches.end(), other.begin(), other.end());
    std::vector<MeshData> meshes = surfaces_from_patches(patches, {});
    MeshData plane = make_plane(40.0);
    for (Vec3& p : plane.positions) p.z = -1.0f;
    meshes.push_back(std::move(plane));
    return meshes;
}

/// A place on an edge of one of the scene's triangles, or its corner.
Vec3 edge_place(const ComparedScene& scene, Numbers& numbers, bool corner) {
    const MeshData& mesh = scene.meshes[numbers.below(scene.meshes.size())];
    const std::size_t triangle = 3 * numbers.below(mesh.indices.size() / 3), first = numbers.below(3);
    const Vec3 a = mesh.positions[mesh.indices[triangle + first]], b = mesh.positions[mesh.indices[triangle + (first + 1) % 3]];
    return corner ? a : a + numbers.next() * (b - a);
}

Vec3 with_axis(Vec3 v, std::size_t axis, float value) {
    return {axis == 0 ? value : v.x, axis == 1 ? value : v.y, axis == 2 ? value : v.z};
}

double dot3(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
std::array<double, 3> cross3(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::array<double, 3> minus(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double size3(const std::array<double, 3>& a) {
    return std::sqrt(dot3(a, a));
}
std::array<double, 3> wide(Vec3 v) {
    return {double(v.x), double(v.y), double(v.z)};
}

/// 16 half-ulps of 1.
constexpr double rounding = 0x1p-20;

/// What rounding explains at a hit.
struct Tolerance {
    double distance_mm;      ///< of the distance
    double tie_mm;           ///< of the distances of two primitives that meet here
    bool at_border = false;  ///< rounding may decide whether the triangle is met
    bool edge_on = false;    ///< and its projection across the ray is no wider than rounding
};

/// Whether a ray is in a triangle is decided by its side of the three edges' lines, each of which may come out wrong within
/// `room_mm` of the line: rounding decides where a line is so near and the farther ones do not rule the triangle out.
void judge_border(const std::array<std::array<double, 3>, 3>& corner, const std::array<double, 3>& d, double room_mm,
                  Tolerance& tolerance) {
    int near = 0, left = 0, right = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::array<double, 3>& a = corner[i];
        const std::array<double, 3>& b = corner[(i + 1) % 3];
        const double length = size3(cross3(minus(b, a), d));
        const double to_line_mm = length > 0.0 ? dot3(cross3(a, b), d) / length : 0.0;
        near += std::abs(to_line_mm) <= room_mm ? 1 : 0;
        left += to_line_mm > room_mm ? 1 : 0;
        right += to_line_mm < -room_mm ? 1 : 0;
    }
    tolerance.at_border = near > 0 && (left == 0 || right == 0);
    tolerance.edge_on = near == 3;
}

/// Distance t = N (a - o) / N d: the corners' places relative to the origin are off by a half-ulp u of their distance L; their
/// products with N and d and the sums of three cost 3 u L / cos each; N itself, of edges of length l between corners that Embree
/// moves to the origin first, is off by 7 u L l, by which the distance moves l / (|N| cos) as far. Two such distances: below 16 u
/// L (1 + l^2 / |N|) / cos. Across the ray, corners are off by 4 u L in the sheared frame, by 9 u L as edges in Embree's Pluecker
/// coordinates.
Tolerance triangle_tolerance(const ComparedScene& scene, const Ray& ray, const RayHit& hit) {
    const MeshData& mesh = scene.meshes[hit.mesh];
    const std::array<double, 3> d = wide(ray.direction);
    std::array<std::array<double, 3>, 3> corner;
    double reach = 0.0, longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        corner[i] = minus(wide(mesh.positions[mesh.indices[3 * std::size_t(hit.triangle) + i]]), wide(ray.origin));
        reach = std::max(reach, size3(corner[i]));
    }
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, size3(minus(corner[(i + 1) % 3], corner[i])));
    const std::array<double, 3> normal = cross3(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
    const double across = std::abs(dot3(normal, d)), size = size3(normal);
    const double distance_mm = rounding * reach * (1.0 + longest * longest / size) * size / across;
    Tolerance tolerance{distance_mm, distance_mm};
    judge_border(corner, d, rounding * reach, tolerance);
    return tolerance;
}

/// A place on a patch is known to 1e-14 of the coordinates; its distance is rounded to a float. Places on a common border of two
/// pieces belong to both; at a pole and where a ray merely touches, meet_piece() leaves it at a part 2^-14 of the piece.
Tolerance hit_tolerance(const ComparedScene& scene, const Ray& ray, const RayHit& hit) {
    if (scene.meshes[hit.mesh].patches.empty()) return triangle_tolerance(scene, ray, hit);
    const double distance_mm = 1.0e-9 + 0x1p-23 * double(hit.distance_mm);
    const PieceBounds bounds = piece_bounds(scene.meshes[hit.mesh].pieces[hit.triangle]);
    const Vec3 size{bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1], bounds.high[2] - bounds.low[2]};
    return {distance_mm, distance_mm + 0x1p-14 * double(length(size))};
}

void compare_hits(const ComparedScene& scene, const Ray& ray, bool met, const RayHit& hit, bool embree_met,
                  const RayHit& embree_hit, std::uint64_t index, BvhComparison& result) {
    if (!met && !embree_met) {
        ++result.same;
        return;
    }
    const bool nearer_is_ours = met && (!embree_met || hit.distance_mm <= embree_hit.distance_mm);
    const RayHit& nearer = nearer_is_ours ? hit : embree_hit;
    const Tolerance tolerance = hit_tolerance(scene, ray, nearer);
    if (met && embree_met) {
        const double difference_mm = std::abs(double(hit.distance_mm) - double(embree_hit.distance_mm));
        if (hit.mesh == embree_hit.mesh && hit.triangle == embree_hit.triangle) {
            result.same_bits += difference_mm == 0.0 ? 1 : 0;
            result.largest_share = std::max(result.largest_share, difference_mm / tolerance.distance_mm);
            if (difference_mm <= tolerance.distance_mm) {
                ++result.same;
                return;
            }
        } else if (difference_mm <=
                   std::max(tolerance.tie_mm, hit_tolerance(scene, ray, nearer_is_ours ? embree_hit : hit).tie_mm)) {
            ++result.ties;
            return;
        }
    }
    if (double(nearer.distance_mm) <= tolerance.distance_mm) {
        ++result.at_start;
    } else if (tolerance.at_border) {
        ++(tolerance.edge_on ? result.edge_on : result.at_border);
    } else {
        if (result.unexplained == 0) result.first_unexplained = index;
        ++result.unexplained;
    }
}

/// Closer and farther than what is met by more than its distance may be wrong: where a triangle is seen edge-on, a neighbour may
/// be met first or be left out as what lies behind.
bool occlusion_fits(const ComparedScene& scene, const BvhView<true>& bvh, const Ray& ray, bool met, const RayHit& hit) {
    if (!met) return !bvh.occluded(ray, 10.0f * scene.radius_mm);
    const double room_mm = std::max(1.0e-6 * double(hit.distance_mm), hit_tolerance(scene, ray, hit).distance_mm);
    const double before_mm = double(hit.distance_mm) - room_mm;
    return bvh.occluded(ray, float(double(hit.distance_mm) + room_mm)) &&
           (before_mm <= 0.0 || !bvh.occluded(ray, float(before_mm)));
}

}  // namespace

std::vector<MeshView> views_of(const std::vector<MeshData>& meshes) {
    std::vector<MeshView> views;
    for (const MeshData& mesh : meshes) views.push_back(mesh.view());
    return views;
}

std::vector<ComparedScene> compared_scenes() {
    std::vector<ComparedScene> scenes;
    scenes.push_back({"random triangles", {triangle_soup(5'000, 10.0f)}, 10.0f, false});
    scenes.push_back({"cabochon", {cabochon()}, 6.0f, true});
    scenes.push_back({"cube of six meshes", cube(8, 2.0f), 3.5f, true});
    scenes.push_back({"ball in three meshes", dealt_out(make_sphere(3.0), 3), 3.0f, true});
    scenes.push_back({"exact ellipsoids on a plane", exact_bodies(), 3.5f, false, true});
    return scenes;
}

Ray compared_ray(const ComparedScene& scene, RayKind kind, std::uint64_t index) {
    Numbers numbers(22 + std::uint64_t(kind), index);
    const float away_mm = 4.0f * scene.radius_mm;
    const Vec3 outside = away_mm * numbers.direction(), inside = numbers.in_ball(0.1f * scene.radius_mm);
    const std::size_t axis = numbers.below(3);
    const float sign = numbers.next() < 0.5f ? -1.0f : 1.0f;
    switch (kind) {
        case RayKind::from_outside:
            return {outside, normalize(numbers.in_ball(scene.radius_mm) - outside)};
        case RayKind::from_inside:
            return {numbers.in_ball(scene.radius_mm), numbers.direction()};
        case RayKind::to_edge:
        case RayKind::to_corner: {
            const Vec3 from = index % 2 == 0 ? outside : inside;
            return {from, normalize(edge_place(scene, numbers, kind == RayKind::to_corner) - from)};
        }
        case RayKind::along_axis:
        case RayKind::along_axis_to_corner: {
            const Vec3 through = kind == RayKind::along_axis ? numbers.in_ball(scene.radius_mm)
                                                             : edge_place(scene, numbers, numbers.next() < 0.5f);
            const float from_mm = index % 3 == 0 ? 0.0f : -sign * away_mm;
            return {with_axis(through, axis, from_mm), with_axis({}, axis, sign)};
        }
        case RayKind::in_plane: {
            const Vec3 through = edge_place(scene, numbers, numbers.next() < 0.5f);
            const Vec3 direction = normalize(with_axis(numbers.direction(), axis, 0.0f));
            return {through - away_mm * direction, direction};
        }
        case RayKind::from_afar: {
            const Vec3 far = 1.0e4f * numbers.direction();
            return {far, normalize(numbers.in_ball(scene.radius_mm) - far)};
        }
        case RayKind::from_surface:
            break;
    }
    const MeshData& mesh = scene.meshes[numbers.below(scene.meshes.size())];
    const std::size_t triangle = 3 * numbers.below(mesh.indices.size() / 3);
    const auto corner = [&](std::size_t i) { return mesh.positions[mesh.indices[triangle + i]]; };
    const float u = numbers.next(), v = (1.0f - u) * numbers.next();
    const Vec3 place = (1.0f - u - v) * corner(0) + u * corner(1) + v * corner(2);
    const Vec3 direction = numbers.direction();
    return {offset_origin(place, normalize(cross(corner(1) - corner(0), corner(2) - corner(0))), direction), direction};
}

Vec3 compared_corner(const ComparedScene& scene, std::uint64_t index) {
    Numbers numbers(20, index);
    return edge_place(scene, numbers, true);
}

BvhComparison compare_with_embree(const ComparedScene& scene, const BvhView<true>& bvh, const EmbreeScene& embree,
                                  std::uint64_t first, std::uint64_t count) {
    BvhComparison result;
    for (std::uint64_t index = first; index < first + count; ++index) {
        const Ray ray = compared_ray(scene, RayKind(index % num_ray_kinds), index);
        RayHit hit, embree_hit;
        const bool met = bvh.closest(ray, hit), embree_met = embree.closest(ray, embree_hit);
        ++result.rays;
        result.met += met ? 1 : 0;
        compare_hits(scene, ray, met, hit, embree_met, embree_hit, index, result);
        result.wrong_occlusion += occlusion_fits(scene, bvh, ray, met, hit) ? 0 : 1;
    }
    return result;
}

}  // namespace opal
