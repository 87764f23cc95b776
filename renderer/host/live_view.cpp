// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/live_view.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace opal {
namespace {

const std::array<std::string, 3> channels = {"R", "G", "B"};
constexpr std::chrono::milliseconds interval(500);
/// Rows of about this many bytes travel together.
constexpr std::size_t packet_bytes = std::size_t(1) << 20;

}  // namespace

struct LiveView::State {
    State(const TevAddress& address, std::string image_name, std::function<Image()> image_source)
        : name(std::move(image_name)), picture(std::move(image_source)), connection(address), connected(connection.alive()) {}

    void run() {
        bool last = false;
        while (connection.alive() && !last) {
            {
                std::unique_lock lock(mutex);
                last = wake.wait_for(lock, interval, [&] { return ending; });
            }
            send(picture());
        }
    }

    void send(const Image& image) {
        if (image.width != width || image.height != height) {
            width = image.width;
            height = image.height;
            connection.send(tev_create_image(name, width, height, channels));
        }
        const int source[3] = {image.find_channel("R"), image.find_channel("G"), image.find_channel("B")};
        const int rows = std::clamp(int(packet_bytes / (sizeof(float) * 3 * std::size_t(width))), 1, height);
        std::vector<float> pixels;
        for (int y = 0; y < height && connection.alive(); y += rows) {
            const int count = std::min(rows, height - y);
            pixels.clear();
            for (int row = y; row < y + count; ++row)
                for (int x = 0; x < width; ++x)
                    for (const int channel : source) pixels.push_back(image.pixel(x, row)[channel]);
            connection.send(tev_update_image(name, y, width, count, channels, pixels));
        }
        connected = connection.alive();
    }

    const std::string name;
    const std::function<Image()> picture;
    TevConnection connection;
    std::atomic<bool> connected;
    int width = 0, height = 0;
    std::mutex mutex;
    std::condition_variable wake;
    bool ending = false;
    std::thread sender;
};

LiveView::LiveView(const TevAddress& address, std::string name, std::function<Image()> picture)
    : state_(std::make_unique<State>(address, std::move(name), std::move(picture))) {
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

}  // namespace opal
