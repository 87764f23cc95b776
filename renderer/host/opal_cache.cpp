// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/opal_cache.h"

namespace opal {

std::shared_ptr<const OpalBody> OpalCache::find(const ObjectDescription& object, const OpalDescription& settings,
                                                std::vector<std::string>& notices) {
    ObjectDescription unplaced = object;
    unplaced.translate_mm = unplaced.rotate_deg = {0.0, 0.0, 0.0};
    for (const Entry& entry : entries_)
        if (entry.object == unplaced && entry.settings == settings) return entry.body;
    entries_.push_back({unplaced, settings, std::make_shared<const OpalBody>(object, settings, notices)});
    return entries_.back().body;
}

}  // namespace opal
