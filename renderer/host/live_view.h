// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "formats/image.h"
#include "renderer/host/tev_client.h"

namespace opal {

/// Shows a picture in the making in tev: a thread of its own asks for the picture twice a second and sends it, so that
/// rendering never waits for a viewer. One that vanishes or hangs is forgotten.
class LiveView {
  public:
    /// `name` is the picture's name in the viewer. `picture` gives its present state, with channels R, G and B; it is called from
    /// the thread, until the object ends.
    LiveView(const TevAddress& address, std::string name, std::function<Image()> picture);
    /// Sends the last state, if the viewer still takes it.
    ~LiveView();
    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;

    /// Whether the viewer is there.
    bool connected() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace opal
