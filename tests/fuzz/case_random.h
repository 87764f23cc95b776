// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "formats/random.h"

namespace opal::fuzz {

/// Random numbers of one case: a pure function of the run's seed and the case's number, so that any case can be made again.
class CaseRandom {
  public:
    CaseRandom(std::uint64_t seed, std::uint64_t index) : seed_(seed), index_(index) {}

    std::uint32_t word() {
        if (used_ == 4) {
            block_ = random_block(seed_, RandomStream::bench, index_, blocks_++);
            used_ = 0;
        }
        return block_.value[used_++];
    }
    /// Uniform in [0, n); n > 0.
    std::size_t below(std::size_t n) { return std::size_t((std::uint64_t(word()) * n) >> 32); }
    int integer(int low, int high) { return low + int(below(std::size_t(high - low + 1))); }
    bool chance(double probability) { return double(uniform_float(word())) < probability; }
    /// With few digits, as people write numbers.
    double between(double low, double high) {
        return std::round(1.0e4 * (low + (high - low) * double(uniform_float(word())))) / 1.0e4;
    }
    template <typename T>
    const T& pick(const std::vector<T>& choices) {
        return choices[below(choices.size())];
    }
    template <typename T>
    T pick(std::initializer_list<T> choices) {
        return choices.begin()[below(choices.size())];
    }

  private:
    std::uint64_t seed_, index_;
    RandomBlock block_ = {};
    std::uint32_t blocks_ = 0;
    int used_ = 4;
};

}  // namespace opal::fuzz
