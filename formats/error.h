// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace opal {

/// Bad input: a file, recipe, scene, grid or flag that cannot be used. Commands end with exit code 2. The message says where
/// (file:line:column or grid), what was wrong and what is allowed.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The input was fine, the machine was not: disk full, output folder vanished, out of memory. Exit code 1.
class SystemError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C) before there was anything to keep. Exit code 1.
class Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted; nothing was written") {}
};

}  // namespace opal
