// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "formats/image.h"
#include "renderer/host/tev_client.h"

namespace opal {

/// Shows a picture in the making in tev. Pictures are handed over and sent by a thread of its own, the newest alone where they
/// come faster than the viewer takes them, so that rendering never waits for a viewer; one that vanishes is forgotten.
class LiveView {
  public:
    /// `name` is the picture's name in the viewer.
    LiveView(const TevAddress& address, std::string name);
    /// Sends the last picture out, if the viewer still takes it.
    ~LiveView();
    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;

    /// Whether the viewer is there. A picture that none takes need not be made.
    bool connected() const;
    /// Shows the channels R, G and B.
    void show(Image picture);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace opal
