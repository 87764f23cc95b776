// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/film_settings.h"
#include "formats/scene.h"
#include "renderer/cpu/render_picture.h"

namespace opal {

/// A small scene without an opal, cheap enough for tests of what is done with samples: a grey plane and a red ball under the
/// studio's lights. `overrides` as for --set.
inline SceneDescription plane_description(const std::vector<std::string>& overrides = {}) {
    return parse_scene(
        "[render]\nwidth = 36\nheight = 20\n[film]\nspectral = true\n"
        "[camera]\nposition_mm = [0, -40, 20]\ntarget_mm = [0, 0, 0]\n"
        "[[material]]\nname = \"grey\"\n[[material]]\nname = \"red\"\nalbedo = [0.6, 0.1, 0.05]\n"
        "[[object]]\nkind = \"plane\"\nmaterial = \"grey\"\n"
        "[[object]]\nkind = \"sphere\"\nradius_mm = 4\nmaterial = \"red\"\ntranslate_mm = [0, 0, 4]\n",
        "plane.toml", overrides);
}

/// That scene, loaded.
class PlaneScene {
  public:
    explicit PlaneScene(const std::vector<std::string>& overrides = {})
        : description(plane_description(overrides)), host(description, notices_), intersector(host.meshes()) {}

    std::unique_ptr<Film> film(std::uint32_t first_sample = 0) const {
        return std::make_unique<Film>(description.render.window(), description.render.width, description.render.height,
                                      description.film.spectral, film_white(description.film), first_sample);
    }
    RenderOutcome render(Film& film, int samples, double noise = 0.0) const {
        return render_picture(host, intersector, {samples, 0.0, noise}, film, [](const RenderProgress&) {});
    }

  private:
    std::vector<std::string> notices_;

  public:
    const SceneDescription description;
    const HostScene host;
    const EmbreeScene intersector;
};

}  // namespace opal
