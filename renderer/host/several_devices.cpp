// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/several_devices.h"

#include <algorithm>
#include <exception>
#include <thread>

namespace opal {

std::vector<std::string> SeveralDevices::names() const {
    std::vector<std::string> all;
    for (const auto& device : devices_)
        for (std::string& name : device->names()) all.push_back(std::move(name));
    return all;
}

std::optional<KernelSeconds> SeveralDevices::kernel_seconds() const {
    KernelSeconds sum;
    for (const auto& device : devices_) {
        const std::optional<KernelSeconds> seconds = device->kernel_seconds();
        if (!seconds) return std::nullopt;
        sum.trace += seconds->trace;
        sum.add += seconds->add;
    }
    return sum;
}

void SeveralDevices::advance(Film& film, std::span<const int> blocks, std::uint32_t samples) {
    if (blocks.empty()) return;
    const std::uint32_t first = film.block(blocks.front()).end_sample, end = first + samples;
    // A film takes shares of one group of samples at a time.
    for (std::uint32_t from = first; from < end;) {
        const std::uint32_t to = std::min(end, (from / noise_group + 1) * noise_group);
        advance_in_group(film, blocks, from, to - from);
        from = to;
    }
}

void SeveralDevices::advance_in_group(Film& film, std::span<const int> blocks, std::uint32_t first, std::uint32_t samples) {
    const std::size_t count = devices_.size();
    while (shares_.size() < count) shares_.push_back(film.make_share());
    const auto begin_of = [&](std::size_t device) { return std::uint32_t(samples * device / count); };
    std::vector<std::exception_ptr> failures(count);
    std::vector<std::thread> threads;
    for (std::size_t d = 0; d < count; ++d) {
        const std::uint32_t begin = begin_of(d), end = begin_of(d + 1);
        if (begin == end) continue;
        for (const int index : blocks) shares_[d]->block(index).end_sample = first + begin;
        threads.emplace_back([&, d, begin, end] {
            try {
                devices_[d]->advance(*shares_[d], blocks, end - begin);
            } catch (...) {
                failures[d] = std::current_exception();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
    for (const int index : blocks) {
        const std::scoped_lock lock(film.block(index).lock);
        for (std::size_t d = 0; d < count; ++d)
            if (begin_of(d) != begin_of(d + 1)) film.take_share(*shares_[d], index);
    }
}

}  // namespace opal
