// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/host/opal_body.h"

namespace opal {

/// Opals that several scenes share, wherever each has them: the frames of an animation load a file once.
class OpalCache {
  public:
    /// The object's opal, loaded where it is not known yet. Throws what OpalBody does; notices are given when it is loaded.
    std::shared_ptr<const OpalBody> find(const ObjectDescription& object, const OpalDescription& settings,
                                         std::vector<std::string>& notices);

  private:
    struct Entry {
        ObjectDescription object;  ///< at the origin, unturned
        OpalDescription settings;
        std::shared_ptr<const OpalBody> body;
    };
    std::vector<Entry> entries_;
};

}  // namespace opal
