// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace opal {

/// Runs `read`, which reads `path`, in a process of its own, whose memory is lost with it, and throws InputError where that ends
/// with a crash: for files whose bytes a library trusts. What `read` throws or returns is not looked at: the caller reads again.
/// `read` must neither wait for threads of this process nor start any.
void require_no_crash(const std::filesystem::path& path, const std::function<void()>& read);

}  // namespace opal
