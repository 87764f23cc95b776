// SPDX-License-Identifier: Apache-2.0
#include "renderer/cuda/cuda_device.h"

#include <algorithm>

#include "renderer/cuda/device_memory.h"
#include "renderer/cuda/path_kernels.h"
#include "renderer/host/device_room.h"
#include "renderer/host/several_devices.h"

namespace opal {
namespace {

static_assert(num_total_parts <= block_pixels, "a thread for each part of the totals");

/// Puts a scene's arrays on the device.
class DeviceCopier : public ArrayCopier {
  private:
    const void* copy_bytes(const void* data, std::size_t bytes, const char*) override {
        return arrays_.emplace_back(std::span(static_cast<const std::byte*>(data), bytes)).data();
    }

    std::vector<DeviceArray<std::byte>> arrays_;
};

std::size_t free_bytes() {
    std::size_t free = 0, all = 0;
    check_cuda(cudaMemGetInfo(&free, &all), "cudaMemGetInfo");
    return free;
}

std::string name_of(int device) {
    cudaDeviceProp properties;
    check_cuda(cudaGetDeviceProperties(&properties, device), "cudaGetDeviceProperties");
    return properties.name;
}

/// Calls of CUDA that follow in this thread are about this device.
int selected(int device) {
    check_cuda(cudaSetDevice(device), "cudaSetDevice");
    return device;
}

class CudaDevice : public PathDevice {
  public:
    CudaDevice(int device, const SceneView& scene, const Bvh& bvh, const Film& film)
        : device_(selected(device)), name_(name_of(device)), has_pieces_(bvh.has_pieces()) {
        require_room(device_memory(scene, bvh, film), free_bytes(), name_);
        const SceneView copy = copied_scene(scene, arrays_);
        wavelengths_ = copy.wavelengths;
        scene_.upload({&copy, 1});
        nodes_.upload(bvh.nodes());
        primitives_.upload(bvh.primitives());
        with_pieces_ = {bvh.root(), bvh.reach_mm(), nodes_.data(), primitives_.data(), std::uint32_t(bvh.primitives().size()),
                        copy.meshes};
        triangles_ = {bvh.root(), bvh.reach_mm(), nodes_.data(), primitives_.data(), std::uint32_t(bvh.primitives().size()),
                      copy.meshes};
    }

    std::vector<std::string> names() const override { return {name_}; }
    std::optional<KernelSeconds> kernel_seconds() const override { return seconds_; }

    void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) override {
        selected(device_);
        if (wavelengths_ <= 4 && !has_pieces_) return advance_in_parts<4>(film, blocks, samples);
        advance_in_parts<8>(film, blocks, samples);
    }

  private:
    /// As many blocks at once as their records have room.
    template <int N>
    void advance_in_parts(Film& film, std::span<const int> blocks, std::uint32_t samples) {
        const std::size_t at_once = blocks_at_once<N>(samples);
        for (std::size_t first = 0; first < blocks.size(); first += at_once)
            launch<N>(film, blocks.subspan(first, std::min(at_once, blocks.size() - first)), samples);
    }

    template <int N>
    void launch(Film& film, std::span<const int> blocks, std::uint32_t samples) {
        const std::vector<LaunchBlock> places = launch_blocks(film, blocks);
        std::vector<LaunchTotals> totals = launch_totals(film, blocks);
        std::vector<PathCounters> counters(blocks.size());
        const FilmSumsView on_host = film.sums_view();
        const std::size_t pixels = std::size_t(film.width()) * std::size_t(film.height());
        const std::span<double> sums(on_host.sums, pixels * std::size_t(film.sums_per_pixel()));
        const std::span<std::uint32_t> counts(on_host.counts, pixels);
        places_.upload(places);
        totals_.upload(totals);
        counters_.upload(counters);
        sums_.upload(sums);
        counts_.upload(counts);
        KernelWork<N> work;
        work.launch = {scene_.data(), places_.data(), std::uint32_t(places.size()), samples, film.window().x0, film.window().y0,
                       film.width(),  on_host};
        work.launch.film.sums = sums_.data();
        work.launch.film.counts = counts_.data();
        records_.require(work.launch.num_records() * sizeof(PathRecord<N>));
        work.records = reinterpret_cast<PathRecord<N>*>(records_.data());
        work.totals = totals_.data();
        work.counters = counters_.data();
        begin_.record();
        cudaError_t launched;
        if constexpr (N == 8)
            launched =
                has_pieces_ ? launch_paths(work, with_pieces_, traced_.get()) : launch_paths(work, triangles_, traced_.get());
        else
            launched = launch_paths(work, triangles_, traced_.get());
        check_cuda(launched, "launch of the paths' kernels");
        end_.record();
        check_cuda(cudaDeviceSynchronize(), "the paths' kernels");
        seconds_.trace += traced_.seconds_since(begin_);
        seconds_.add += end_.seconds_since(traced_);
        totals_.download(totals);
        counters_.download(counters);
        fetch(film, blocks, places, totals, counters, samples);
    }

    /// Takes over the film's new sums; every block is locked while it changes.
    void fetch(Film& film, std::span<const int> blocks, std::span<const LaunchBlock> places, std::span<const LaunchTotals> totals,
               std::span<const PathCounters> counters, std::uint32_t samples) {
        const FilmSumsView on_host = film.sums_view();
        const std::size_t of_pixel = std::size_t(film.sums_per_pixel());
        std::vector<std::uint32_t> new_counts(std::size_t(film.width()) * std::size_t(film.height()));
        std::vector<double> new_sums(new_counts.size() * of_pixel);
        sums_.download(new_sums);
        counts_.download(new_counts);
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            const LaunchBlock& place = places[i];
            FilmBlock& block = film.block(blocks[i]);
            const std::scoped_lock lock(block.lock);
            for (int y = place.y0; y < place.y1; ++y) {
                const std::size_t first = std::size_t(y) * std::size_t(film.width()) + std::size_t(place.x0);
                const std::size_t width = std::size_t(place.x1 - place.x0);
                std::copy_n(new_sums.data() + first * of_pixel, width * of_pixel, on_host.sums + first * of_pixel);
                std::copy_n(new_counts.data() + first, width, on_host.counts + first);
            }
            finish_block(block, samples, (place.x1 - place.x0) * (place.y1 - place.y0), totals[i], counters[i]);
        }
    }

    int device_;  ///< before all that lies on it
    std::string name_;
    bool has_pieces_;
    int wavelengths_ = 1;
    DeviceCopier arrays_;
    DeviceArray<SceneView> scene_;
    DeviceArray<BvhNode> nodes_;
    DeviceArray<BvhPrimitive> primitives_;
    BvhView<true> with_pieces_;
    BvhView<false> triangles_;
    DeviceArray<LaunchBlock> places_;
    DeviceArray<LaunchTotals> totals_;
    DeviceArray<PathCounters> counters_;
    DeviceArray<double> sums_;
    DeviceArray<std::uint32_t> counts_;
    DeviceArray<std::byte> records_;
    DeviceEvent begin_, traced_, end_;
    KernelSeconds seconds_;
};

}  // namespace

CudaPresence find_cuda_devices() {
    int devices = 0;
    const cudaError_t error = cudaGetDeviceCount(&devices);
    if (error != cudaSuccess) {
        cudaGetLastError();
        return {{}, cudaGetErrorString(error)};
    }
    if (devices == 0) return {{}, "there is none"};
    CudaPresence presence;
    for (int device = 0; device < devices; ++device) presence.names.push_back(name_of(device));
    return presence;
}

std::unique_ptr<PathDevice> make_cuda_device(const SceneView& scene, const Bvh& bvh, const Film& film) {
    std::vector<std::unique_ptr<PathDevice>> devices;
    for (int device = 0; device < int(find_cuda_devices().names.size()); ++device)
        devices.push_back(std::make_unique<CudaDevice>(device, scene, bvh, film));
    if (devices.size() == 1) return std::move(devices.front());
    return std::make_unique<SeveralDevices>(std::move(devices));
}

}  // namespace opal
