// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace opal {

/// A mean over independent samples.
struct Estimate {
    double mean = 0.0;
    double standard_error = 0.0;
};

class SampleMean {
  public:
    void add(double value) {
        ++count_;
        const double step = value - mean_;
        mean_ += step / double(count_);
        squares_ += step * (value - mean_);
    }
    std::uint64_t count() const { return count_; }
    Estimate estimate() const {
        const double variance = count_ > 1 ? squares_ / double(count_ - 1) : 0.0;
        return {mean_, std::sqrt(variance / double(std::max<std::uint64_t>(1, count_)))};
    }
    /// Standard deviation of a single sample.
    double deviation() const { return count_ > 1 ? std::sqrt(squares_ / double(count_ - 1)) : 0.0; }

  private:
    std::uint64_t count_ = 0;
    double mean_ = 0.0, squares_ = 0.0;
};

/// The share of `count` yes-or-no trials that `hits` is.
inline Estimate share_of(std::uint64_t hits, std::uint64_t count) {
    const double n = double(std::max<std::uint64_t>(1, count)), share = double(hits) / n;
    return {share, std::sqrt(share * (1.0 - share) / n)};
}

/// One measurement of the failure map.
struct StabilityRow {
    std::string test_case;  ///< which of the cases
    std::string method;
    std::string input;   ///< what is varied, with its unit
    double value = 0.0;  ///< of the input
    Estimate error;
    std::string unit;     ///< of the error, and what it is
    std::string outcome;  ///< what the programs do there
    std::string kept_by;  ///< test that keeps it so
};

using StabilityRows = std::vector<StabilityRow>;

}  // namespace opal
