// SPDX-License-Identifier: GPL-3.0-or-later
#include "../entry_points.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    opal::fuzz::check_scene_text({reinterpret_cast<const char*>(data), size});
    return 0;
}
