// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/tev_client.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "formats/error.h"

namespace opal {
namespace {

static_assert(std::endian::native == std::endian::little, "packets are little-endian");

// The viewer's numbers for the kinds of packets; of the update's three versions the one with offsets and strides.
enum class PacketType : char { close_image = 2, create_image = 4, update_image = 6 };

class PacketWriter {
  public:
    explicit PacketWriter(PacketType type) {
        add(std::uint32_t(0));
        add(type);
    }
    template <typename T>
    void add(T value) {
        const char* bytes = reinterpret_cast<const char*>(&value);
        packet_.insert(packet_.end(), bytes, bytes + sizeof(T));
    }
    void add(const std::string& text) { packet_.insert(packet_.end(), text.c_str(), text.c_str() + text.size() + 1); }
    void add(std::span<const float> values) {
        const char* bytes = reinterpret_cast<const char*>(values.data());
        packet_.insert(packet_.end(), bytes, bytes + values.size_bytes());
    }
    TevPacket finished() {
        const auto size = static_cast<std::uint32_t>(packet_.size());
        std::memcpy(packet_.data(), &size, sizeof size);
        return std::move(packet_);
    }

  private:
    TevPacket packet_;
};

constexpr char no_focus = 0, grab_focus = 1;

/// Connects within the time that is left; the socket stays non-blocking. -1 where it cannot.
int connect_to(const addrinfo& address, int timeout_ms) {
    const int descriptor = ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol);
    if (descriptor < 0) return -1;
    if (::connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) return descriptor;
    pollfd ready = {descriptor, POLLOUT, 0};
    int error = errno;
    socklen_t size = sizeof error;
    if (error == EINPROGRESS && ::poll(&ready, 1, timeout_ms) == 1 &&
        ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0)
        return descriptor;
    ::close(descriptor);
    return -1;
}

/// How long a viewer may take nothing before it counts as gone.
constexpr int stalled_ms = 2000;

}  // namespace

TevAddress parse_tev_address(const std::string& text) {
    TevAddress address;
    const std::size_t colon = text.rfind(':');
    const std::string host = text.substr(0, colon);
    if (!host.empty()) address.host = host;
    if (colon != std::string::npos) {
        const char* const end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data() + colon + 1, end, address.port);
        if (error != std::errc() || next != end || address.port == 0)
            throw InputError(fmt::format("--tev {}: expected host, host:port or :port, the port from 1 to 65535", text));
    }
    return address;
}

TevPacket tev_create_image(const std::string& name, int width, int height, std::span<const std::string> channels) {
    PacketWriter writer(PacketType::create_image);
    writer.add(grab_focus);
    writer.add(name);
    writer.add(std::int32_t(width));
    writer.add(std::int32_t(height));
    writer.add(std::int32_t(channels.size()));
    for (const std::string& channel : channels) writer.add(channel);
    return writer.finished();
}

TevPacket tev_update_image(const std::string& name, int y, int width, int height, std::span<const std::string> channels,
                           std::span<const float> pixels) {
    PacketWriter writer(PacketType::update_image);
    writer.add(no_focus);
    writer.add(name);
    writer.add(std::int32_t(channels.size()));
    for (const std::string& channel : channels) writer.add(channel);
    writer.add(std::int32_t(0));
    writer.add(std::int32_t(y));
    writer.add(std::int32_t(width));
    writer.add(std::int32_t(height));
    for (std::size_t c = 0; c < channels.size(); ++c) writer.add(std::int64_t(c));
    for (std::size_t c = 0; c < channels.size(); ++c) writer.add(std::int64_t(channels.size()));
    writer.add(pixels);
    return writer.finished();
}

TevPacket tev_close_image(const std::string& name) {
    PacketWriter writer(PacketType::close_image);
    writer.add(name);
    return writer.finished();
}

TevConnection::TevConnection(const TevAddress& address, double timeout_s) {
    addrinfo hints = {};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found) != 0) return;
    for (const addrinfo* candidate = found; candidate && socket_ < 0; candidate = candidate->ai_next)
        socket_ = connect_to(*candidate, int(1000.0 * timeout_s));
    ::freeaddrinfo(found);
}

TevConnection::~TevConnection() {
    close();
}

void TevConnection::close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
}

bool TevConnection::send(const TevPacket& packet) {
    std::size_t sent = 0;
    while (socket_ >= 0 && sent < packet.size()) {
        // No SIGPIPE where the viewer has gone.
        const ssize_t count = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
        if (count > 0) {
            sent += std::size_t(count);
            continue;
        }
        pollfd ready = {socket_, POLLOUT, 0};
        const bool full = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
        if (!full || ::poll(&ready, 1, stalled_ms) == 0) close();
    }
    return socket_ >= 0;
}

}  // namespace opal
