// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "renderer/core/scene_view.h"

namespace opal {

/// Where copies of a scene's arrays go.
class ArrayCopier {
  public:
    virtual ~ArrayCopier() = default;

    /// A copy of `count` elements; null where there are none. `what`: names them for a report of memory.
    template <class T>
    const T* copy(const T* data, std::size_t count, const char* what) {
        if (!data || count == 0) return nullptr;
        return static_cast<const T*>(copy_bytes(data, count * sizeof(T), what));
    }

  protected:
    /// Aligned to at least 64 bytes.
    virtual const void* copy_bytes(const void* data, std::size_t bytes, const char* what) = 0;
};

/// Puts copies into memory of the host.
class HostArrayCopier : public ArrayCopier {
  public:
    std::size_t total_bytes() const { return total_bytes_; }

  private:
    const void* copy_bytes(const void* data, std::size_t bytes, const char* what) override;

    std::vector<std::unique_ptr<void, decltype(&std::free)>> arrays_;
    std::size_t total_bytes_ = 0;
};

/// The same scene with all that it points to copied: what crosses to a device. Arrays that several bodies share are copied for
/// each.
SceneView copied_scene(const SceneView& scene, ArrayCopier& copier);

/// Bytes of what a scene points to, by what it is.
struct SceneMemory {
    struct Item {
        std::string what;
        std::size_t bytes = 0;
    };
    std::vector<Item> items;  ///< in the order in which a scene first has them

    std::size_t total_bytes() const;
};

/// What `copied_scene` would take.
SceneMemory scene_memory(const SceneView& scene);

}  // namespace opal
