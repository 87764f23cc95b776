// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_error.h"

#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace opal {
namespace {

/// An estimate from all seeds, and its standard error from those that leave one out: `of(left_out)`, -1 for none.
Estimate jackknife(std::size_t seeds, const std::function<double(int)>& of) {
    std::vector<double> without(seeds);
    double mean = 0.0, square = 0.0;
    for (std::size_t k = 0; k < seeds; ++k) mean += (without[k] = of(int(k))) / double(seeds);
    for (const double value : without) square += (value - mean) * (value - mean);
    return {of(-1), std::sqrt(square * (double(seeds) - 1.0) / double(seeds))};
}

/// Sum, sum of squares and number over the seeds but one.
struct Moments {
    double sum = 0.0, square = 0.0, count = 0.0;
    void add(double value) {
        sum += value;
        square += value * value;
        count += 1.0;
    }
    /// Of the squared mean, without bias.
    double squared_mean() const { return (sum * sum - square) / (count * (count - 1.0)); }
    double variance() const { return (square - sum * sum / count) / (count - 1.0); }
};

template <class Value, class Statistic>
double weighted_sum(std::size_t seeds, const std::vector<double>& weights, int left_out, const Value& value,
                    const Statistic& statistic) {
    double total = 0.0;
    for (std::size_t p = 0; p < weights.size(); ++p)
        for (std::size_t c = 0; c < 3; ++c) {
            Moments moments;
            for (std::size_t k = 0; k < seeds; ++k)
                if (int(k) != left_out) moments.add(value(k, p, c));
            total += weights[p] * statistic(moments);
        }
    return total;
}

}  // namespace

Patches patches_of(const std::vector<std::uint32_t>& pixels, int width, int edge) {
    std::map<std::pair<int, int>, std::vector<std::size_t>> found;
    for (std::size_t p = 0; p < pixels.size(); ++p)
        found[{int(pixels[p]) / width / edge, int(pixels[p]) % width / edge}].push_back(p);
    Patches patches;
    for (auto& [place, members] : found)
        if (2 * members.size() >= std::size_t(edge * edge)) patches.push_back(std::move(members));
    return patches;
}

SeedPictures patch_means(const SeedPictures& pictures, const Patches& patches) {
    SeedPictures means(pictures.size(), std::vector<Opponent>(patches.size(), Opponent{}));
    for (std::size_t k = 0; k < pictures.size(); ++k)
        for (std::size_t i = 0; i < patches.size(); ++i)
            for (const std::size_t p : patches[i])
                for (std::size_t c = 0; c < 3; ++c) means[k][i][c] += pictures[k][p][c] / double(patches[i].size());
    return means;
}

std::vector<double> relative_weights(const SeedPictures& reference) {
    const std::size_t pixels = reference.front().size();
    std::vector<double> luminance(pixels, 0.0);
    double mean_square = 0.0;
    for (std::size_t p = 0; p < pixels; ++p) {
        for (const auto& picture : reference) luminance[p] += picture[p][0] / double(reference.size());
        mean_square += luminance[p] * luminance[p] / double(pixels);
    }
    std::vector<double> weights(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        weights[p] = 1.0 / ((luminance[p] * luminance[p] + 0.1 * mean_square) * double(pixels));
    return weights;
}

Estimate squared_bias(const SeedPictures& picture, const SeedPictures& reference, const std::vector<double>& weights) {
    const auto difference = [&](std::size_t k, std::size_t p, std::size_t c) { return picture[k][p][c] - reference[k][p][c]; };
    return jackknife(picture.size(), [&](int left_out) {
        return weighted_sum(picture.size(), weights, left_out, difference, [](const Moments& m) { return m.squared_mean(); });
    });
}

Estimate seed_variance(const SeedPictures& picture, const std::vector<double>& weights) {
    const auto value = [&](std::size_t k, std::size_t p, std::size_t c) { return picture[k][p][c]; };
    return jackknife(picture.size(), [&](int left_out) {
        return weighted_sum(picture.size(), weights, left_out, value, [](const Moments& m) { return m.variance(); });
    });
}

Estimate relative_mean_error(const SeedPictures& picture, const SeedPictures& reference) {
    return jackknife(picture.size(), [&](int left_out) {
        double sum = 0.0, of_reference = 0.0;
        for (std::size_t k = 0; k < picture.size(); ++k) {
            if (int(k) == left_out) continue;
            for (std::size_t p = 0; p < picture[k].size(); ++p) {
                sum += picture[k][p][0];
                of_reference += reference[k][p][0];
            }
        }
        return sum / of_reference - 1.0;
    });
}

}  // namespace opal
