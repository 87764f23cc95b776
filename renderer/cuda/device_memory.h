// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include <span>
#include <string>
#include <utility>

#include "formats/error.h"

/// Memory and moments of a CUDA device, and its errors as exceptions.
namespace opal {

/// Throws SystemError, naming the call, where one failed.
inline void check_cuda(cudaError_t error, const char* call) {
    if (error == cudaSuccess) return;
    // Reading it clears it, so that the next call is not blamed for this one.
    cudaGetLastError();
    throw SystemError(std::string("CUDA: ") + call + ": " + cudaGetErrorString(error));
}

/// An array on the device. Grows only.
template <class T>
class DeviceArray {
  public:
    DeviceArray() = default;
    explicit DeviceArray(std::span<const T> content) { upload(content); }
    ~DeviceArray() { cudaFree(data_); }
    DeviceArray(DeviceArray&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), capacity_(std::exchange(other.capacity_, 0)) {}
    DeviceArray& operator=(DeviceArray&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(capacity_, other.capacity_);
        return *this;
    }

    T* data() const { return data_; }

    /// Room for `count` elements; what was there is lost.
    void require(std::size_t count) {
        if (count <= capacity_) return;
        check_cuda(cudaFree(data_), "cudaFree");
        data_ = nullptr;
        capacity_ = 0;
        check_cuda(cudaMalloc(&data_, count * sizeof(T)), "cudaMalloc");
        capacity_ = count;
    }
    void upload(std::span<const T> content) {
        require(content.size());
        if (content.empty()) return;
        check_cuda(cudaMemcpy(data_, content.data(), content.size_bytes(), cudaMemcpyHostToDevice), "cudaMemcpy to the device");
    }
    void download(std::span<T> content) const {
        if (content.empty()) return;
        check_cuda(cudaMemcpy(content.data(), data_, content.size_bytes(), cudaMemcpyDeviceToHost), "cudaMemcpy from the device");
    }

  private:
    T* data_ = nullptr;
    std::size_t capacity_ = 0;
};

/// A moment in the work of the device that was current when it was made.
class DeviceEvent {
  public:
    DeviceEvent() { check_cuda(cudaEventCreate(&event_), "cudaEventCreate"); }
    ~DeviceEvent() { cudaEventDestroy(event_); }
    DeviceEvent(const DeviceEvent&) = delete;
    DeviceEvent& operator=(const DeviceEvent&) = delete;

    cudaEvent_t get() const { return event_; }
    /// After all that was queued before.
    void record() { check_cuda(cudaEventRecord(event_), "cudaEventRecord"); }
    /// From another moment to this one; both are over.
    double seconds_since(const DeviceEvent& earlier) const {
        float milliseconds = 0.0f;
        check_cuda(cudaEventElapsedTime(&milliseconds, earlier.event_, event_), "cudaEventElapsedTime");
        return 1.0e-3 * double(milliseconds);
    }

  private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace opal
