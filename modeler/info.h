// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "formats/opal_asset.h"

namespace opal {

/// Everything `opal-model info` knows about an opal: sizes in mm, counts, constants with the effective index
/// n_eff = f n_s + (1 - f) n_m, f = pi / (3 sqrt 2), and the (111) wavelength at normal incidence, 2 n_eff sqrt(2/3) d in nm.
nlohmann::json describe_opal(const OpalAsset& asset);

/// The same, laid out for a person.
std::string opal_info_text(const nlohmann::json& description);

}  // namespace opal
