// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/live_view.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace opal {
namespace {

const std::array<std::string, 3> channels = {"R", "G", "B"};
/// Rows of about this many bytes travel together.
constexpr std::size_t packet_bytes = std::size_t(1) << 20;

}  // namespace

struct LiveView::State {
    State(const TevAddress& address, std::string image_name) : name(std::move(image_name)), connection(address) {
        connected = connection.alive();
    }

    void run() {
        while (true) {
            Image picture;
            {
                std::unique_lock lock(mutex);
                wake.wait(lock, [&] { return waiting || ending; });
                if (!waiting) return;
                picture = std::move(*waiting);
                waiting.reset();
            }
            send(picture);
        }
    }

    void send(const Image& picture) {
        if (picture.width != width || picture.height != height) {
            width = picture.width;
            height = picture.height;
            connection.send(tev_create_image(name, width, height, channels));
        }
        const int source[3] = {picture.find_channel("R"), picture.find_channel("G"), picture.find_channel("B")};
        const int rows = std::clamp(int(packet_bytes / (sizeof(float) * 3 * std::size_t(width))), 1, height);
        std::vector<float> pixels;
        for (int y = 0; y < height && connection.alive(); y += rows) {
            const int count = std::min(rows, height - y);
            pixels.clear();
            for (int row = y; row < y + count; ++row)
                for (int x = 0; x < width; ++x)
                    for (const int channel : source) pixels.push_back(picture.pixel(x, row)[channel]);
            connection.send(tev_update_image(name, y, width, count, channels, pixels));
        }
        connected = connection.alive();
    }

    const std::string name;
    TevConnection connection;
    std::atomic<bool> connected = false;
    int width = 0, height = 0;
    std::mutex mutex;
    std::condition_variable wake;
    std::optional<Image> waiting;
    bool ending = false;
    std::thread sender;
};

LiveView::LiveView(const TevAddress& address, std::string name) : state_(std::make_unique<State>(address, std::move(name))) {
    state_->sender = std::thread([state = state_.get()] { state->run(); });
}

LiveView::~LiveView() {
    {
        const std::scoped_lock lock(state_->mutex);
        state_->ending = true;
    }
    state_->wake.notify_one();
    state_->sender.join();
}

bool LiveView::connected() const {
    return state_->connected;
}

void LiveView::show(Image picture) {
    {
        const std::scoped_lock lock(state_->mutex);
        state_->waiting = std::move(picture);
    }
    state_->wake.notify_one();
}

}  // namespace opal
