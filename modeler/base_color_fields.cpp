// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/base_color_fields.h"

#include <fmt/format.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "formats/error.h"
#include "formats/field_summary.h"
#include "formats/grain_map.h"
#include "formats/random.h"
#include "formats/units.h"
#include "modeler/float_grid_file.h"
#include "modeler/gradient_noise.h"

namespace opal {
namespace {

constexpr double max_field_voxels = 0x1p31;
constexpr double min_voxel_size_mm = 1.5e-5;
/// Voxels along what the factor varies over: enough for linear interpolation to follow it (a sine sampled 16 times per period is
/// off by 2 % of its amplitude at most).
constexpr double voxels_per_noise_cell = 4.0;
constexpr double voxels_per_period = 16.0;
/// A field shows at least so many voxels along the longest side.
constexpr double min_voxels_along_shape = 16.0;
/// The farthest corner of an interpolation cell that holds a place inside is this many voxels from it; a little more for
/// rounding.
constexpr double reach_in_voxels = 1.7321;

/// One of the three fields.
struct FieldJob {
    const FieldRecipe& recipe;
    const char* key;        ///< in the recipe
    const char* grid_name;  ///< in the file
    std::uint32_t number;   ///< tells the fields' random numbers apart
    double coefficient;     ///< that the factor multiplies
};

double automatic_voxel_size_mm(const FieldJob& job, const openvdb::FloatGrid* user_grid, double label_voxel_mm) {
    switch (job.recipe.kind) {
        case FieldKind::noise:
            return std::ldexp(job.recipe.scale_mm, 1 - job.recipe.octaves) / voxels_per_noise_cell;
        case FieldKind::layers:
            return job.recipe.scale_mm / voxels_per_period;
        case FieldKind::grid: {
            const openvdb::Vec3d size_mm = user_grid->voxelSize();
            return std::min({size_mm.x(), size_mm.y(), size_mm.z()});
        }
        default:
            return label_voxel_mm;
    }
}

double field_voxel_size_mm(const FieldJob& job, const openvdb::FloatGrid* user_grid, const Shape& shape, double label_voxel_mm) {
    const openvdb::Vec3d extents_mm = shape.bounds_mm().extents();
    const double longest_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
    const double coarsest_mm = longest_mm / min_voxels_along_shape;
    if (job.recipe.voxel_size_mm <= 0.0)
        return std::max(label_voxel_mm, std::min(coarsest_mm, automatic_voxel_size_mm(job, user_grid, label_voxel_mm)));
    const double size_mm = job.recipe.voxel_size_mm;
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= std::ceil(extents_mm[axis] / size_mm);
    if (!(size_mm >= min_voxel_size_mm) || !(voxels <= max_field_voxels))
        throw InputError(
            fmt::format("base_color.{}.voxel_size_mm {:.4g}: would take {:.3g} voxels; at most {:.3g} of at least "
                        "{:.3g} mm are possible",
                        job.key, size_mm, voxels, max_field_voxels, min_voxel_size_mm));
    return size_mm;
}

void require_factors(const openvdb::FloatGrid& grid, const std::filesystem::path& file) {
    const auto allowed = [](float value) { return value >= 0.0f && std::isfinite(value); };
    if (!allowed(grid.background()))
        throw InputError(fmt::format("{}: grid '{}': its background is {}; allowed: factors from 0", file.string(),
                                     grid.getName(), grid.background()));
    // Interpolation reads inactive voxels too.
    for (auto value = grid.cbeginValueAll(); value; ++value)
        if (!allowed(*value))
            throw InputError(fmt::format("{}: grid '{}': voxel [{}, {}, {}] holds {}; allowed: factors from 0", file.string(),
                                         grid.getName(), value.getCoord().x(), value.getCoord().y(), value.getCoord().z(),
                                         *value));
}

/// Values `coefficient * factor(accessor, place_mm)` at all voxels near the shape; each leaf has an accessor of its own.
template <typename MakeAccessor, typename Factor>
openvdb::FloatGrid::Ptr fill_field(const openvdb::FloatGrid& level_set, double coefficient, const MakeAccessor& make_accessor,
                                   const Factor& factor) {
    const double voxel_size_mm = level_set.voxelSize().x();
    const auto near_shape = openvdb::tools::sdfInteriorMask(level_set, static_cast<float>(reach_in_voxels * voxel_size_mm));
    const auto tree = std::make_shared<openvdb::FloatTree>(near_shape->tree(), 0.0f, openvdb::TopologyCopy());
    tree->voxelizeActiveTiles();
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(*tree);
    leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
        if (interrupt_requested()) return;
        auto accessor = make_accessor();
        for (auto value = leaf.beginValueOn(); value; ++value) {
            const openvdb::Vec3d place_mm = value.getCoord().asVec3d() * voxel_size_mm;
            value.setValue(static_cast<float>(coefficient * factor(accessor, place_mm)));
        }
    });
    throw_if_interrupted();
    openvdb::tools::prune(*tree);
    return openvdb::FloatGrid::create(tree);
}

/// The same for a factor that needs no accessor.
template <typename Factor>
openvdb::FloatGrid::Ptr fill_field(const openvdb::FloatGrid& level_set, double coefficient, const Factor& factor) {
    return fill_field(
        level_set, coefficient, [] { return 0; }, [&](int, const openvdb::Vec3d& place_mm) { return factor(place_mm); });
}

openvdb::FloatGrid::Ptr noise_field(const FieldJob& job, const openvdb::FloatGrid& level_set, std::uint64_t seed) {
    const RandomBlock block = random_block(seed, RandomStream::field_noise, job.number, 0);
    const std::uint64_t field_seed = (std::uint64_t(block.value[0]) << 32) | block.value[1];
    return fill_field(level_set, job.coefficient, [&](const openvdb::Vec3d& place_mm) {
        return 1.0 + job.recipe.contrast * fractal_noise(place_mm / job.recipe.scale_mm, {field_seed}, job.recipe.octaves);
    });
}

openvdb::FloatGrid::Ptr layers_field(const FieldJob& job, const openvdb::FloatGrid& level_set) {
    const openvdb::Vec3d normal = openvdb::Vec3d(job.recipe.direction.data()).unit();
    return fill_field(level_set, job.coefficient, [&](const openvdb::Vec3d& place_mm) {
        return 1.0 + job.recipe.contrast * std::sin(2.0 * units::pi * normal.dot(place_mm) / job.recipe.scale_mm);
    });
}

openvdb::FloatGrid::Ptr user_field(const FieldJob& job, const openvdb::FloatGrid& level_set, const openvdb::FloatGrid& grid) {
    return fill_field(
        level_set, job.coefficient, [&] { return grid.getConstAccessor(); },
        [&](const openvdb::FloatGrid::ConstAccessor& values, const openvdb::Vec3d& place_mm) {
            return static_cast<double>(openvdb::tools::BoxSampler::sample(values, grid.worldToIndex(place_mm)));
        });
}

/// Labelling a level set that is larger by the reach of interpolation extends the grains beyond the surface as their metric says.
openvdb::FloatGrid::Ptr grains_field(const FieldJob& job, const openvdb::FloatGrid& level_set, const GrainLabeller& label,
                                     std::uint64_t seed) {
    const openvdb::FloatGrid::Ptr larger = level_set.deepCopy();
    const auto reach_mm = static_cast<float>(reach_in_voxels * level_set.voxelSize().x());
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(larger->tree());
    leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
        for (auto value = leaf.beginValueAll(); value; ++value) value.setValue(*value - reach_mm);
    });
    return map_grains<openvdb::FloatGrid>(*label(*larger), job.grid_name, [&](std::int32_t grain) {
        const RandomBlock block = random_block(seed, RandomStream::field_grains, static_cast<std::uint64_t>(grain), job.number);
        const double u = uniform_double(block.value[0], block.value[1]);
        return static_cast<float>(job.coefficient * (1.0 + job.recipe.contrast * (2.0 * u - 1.0)));
    });
}

bool can_vary(const FieldJob& job) {
    if (job.recipe.kind == FieldKind::constant || job.coefficient == 0.0) return false;
    return job.recipe.kind == FieldKind::grid || job.recipe.contrast > 0.0;
}

openvdb::FloatGrid::Ptr make_field(const FieldJob& job, const Shape& shape, const GrainLabeller& label, const OpalAsset& asset) {
    openvdb::FloatGrid::Ptr user_grid;
    if (job.recipe.kind == FieldKind::grid) {
        user_grid = read_float_grid(job.recipe.file, job.recipe.grid);
        require_factors(*user_grid, job.recipe.file);
    }
    const double label_voxel_mm = asset.shape->voxelSize().x();
    const double voxel_size_mm = field_voxel_size_mm(job, user_grid.get(), shape, label_voxel_mm);
    const openvdb::FloatGrid::Ptr level_set = voxel_size_mm == label_voxel_mm ? asset.shape : shape.level_set(voxel_size_mm);
    openvdb::FloatGrid::Ptr field;
    switch (job.recipe.kind) {
        case FieldKind::noise:
            field = noise_field(job, *level_set, asset.seed);
            break;
        case FieldKind::layers:
            field = layers_field(job, *level_set);
            break;
        case FieldKind::grains:
            field = grains_field(job, *level_set, label, asset.seed);
            break;
        default:
            field = user_field(job, *level_set, *user_grid);
            break;
    }
    field->setTransform(level_set->transform().copy());
    field->setGridClass(openvdb::GRID_FOG_VOLUME);
    field->setName(job.grid_name);
    return field;
}

/// What is left of a field: a grid, or the one value that stands for it.
struct FieldResult {
    openvdb::FloatGrid::Ptr grid;
    double constant;
};

FieldResult evaluate(const FieldJob& job, const Shape& shape, const GrainLabeller& label, const OpalAsset& asset) {
    if (!can_vary(job)) return {nullptr, job.coefficient};
    const openvdb::FloatGrid::Ptr field = make_field(job, shape, label, asset);
    const FieldSummary summary = summarize_field(*field, nullptr);
    if (!std::isfinite(summary.max))
        throw InputError(fmt::format("base_color.{}: coefficient times factor is larger than a float can hold", job.key));
    if (summary.min == summary.max) return {nullptr, static_cast<double>(summary.max)};
    return {field, job.coefficient};
}

}  // namespace

void add_base_color_fields(const BaseColorRecipe& recipe, const Shape& shape, const GrainLabeller& label, OpalAsset& asset) {
    OpalConstants& constants = asset.constants;
    const FieldResult scale =
        evaluate({recipe.sigma_a_field, "sigma_a_field", grid_names::sigma_a_scale, 0, recipe.sigma_a_per_mm > 0.0 ? 1.0 : 0.0},
                 shape, label, asset);
    asset.sigma_a_scale = scale.grid;
    if (recipe.sigma_a_per_mm > 0.0)
        for (double& value : constants.sigma_a_per_mm.value) value *= scale.constant;

    const FieldResult rayleigh = evaluate({recipe.sigma_s_rayleigh_field, "sigma_s_rayleigh_field", grid_names::sigma_s_rayleigh,
                                           1, recipe.sigma_s_rayleigh_400nm_per_mm},
                                          shape, label, asset);
    asset.sigma_s_rayleigh_400nm = rayleigh.grid;
    constants.sigma_s_rayleigh_400nm_per_mm = rayleigh.constant;

    const FieldResult mie =
        evaluate({recipe.sigma_s_mie_field, "sigma_s_mie_field", grid_names::sigma_s_mie, 2, recipe.sigma_s_mie_per_mm}, shape,
                 label, asset);
    asset.sigma_s_mie = mie.grid;
    constants.sigma_s_mie_per_mm = mie.constant;
}

}  // namespace opal
