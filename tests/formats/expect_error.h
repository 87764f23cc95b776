// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "formats/error.h"

namespace opal {

/// The message of the InputError that `action` throws; a test failure if it throws none.
template <typename Action>
std::string input_error_of(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return "";
}

#define EXPECT_INPUT_ERROR(action, part)                                                                     \
    do {                                                                                                     \
        const std::string message_ = ::opal::input_error_of([&] { action; });                                \
        EXPECT_NE(message_.find(part), std::string::npos) << "message: " << message_ << "\nlacks: " << part; \
    } while (false)

}  // namespace opal
