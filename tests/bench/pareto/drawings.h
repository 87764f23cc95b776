// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "picture_error.h"

namespace opal {

/// What lights a scene's gem: its own environment, or the built-in light tent, whose broad light leaves far less noise.
enum class Lighting { of_the_scene, tent };

/// What follows the paths: with Embree and in single precision as opal-render does on the processor, or with the hierarchy that
/// devices walk, in single or in double precision.
enum class Tracing { embree, own_tree, own_tree_in_double };

/// One scene with some settings, and what has been drawn of it, seed by seed.
class Drawings {
  public:
    virtual ~Drawings() = default;

    /// Draws the pixels once more, with another seed.
    virtual void draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed,
                      Lighting lighting = Lighting::of_the_scene) = 0;
    /// Of the scene: what it points to, without the hierarchies over its meshes.
    virtual std::size_t memory_bytes() const = 0;
    virtual double load_s() const = 0;

    /// Means of the pixels drawn, for every seed.
    const SeedPictures& pictures(Lighting lighting = Lighting::of_the_scene) const {
        return lighting == Lighting::tent ? tent_pictures_ : pictures_;
    }
    /// Processor time per sample in the scene's own light, for every seed.
    const std::vector<double>& sample_s() const { return sample_s_; }

  protected:
    /// `sample_s`: processor time per sample.
    void keep(std::vector<Opponent> picture, double sample_s, Lighting lighting) {
        if (lighting == Lighting::tent) {
            tent_pictures_.push_back(std::move(picture));
            return;
        }
        pictures_.push_back(std::move(picture));
        sample_s_.push_back(sample_s);
    }

  private:
    SeedPictures pictures_, tent_pictures_;
    std::vector<double> sample_s_;
};

}  // namespace opal
