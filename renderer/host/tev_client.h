// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// The image viewer tev (Mueller et al., https://github.com/Tom94/tev) shows pictures that other programs send it over TCP. A
/// packet is its own length in bytes (32 bits, the length's four bytes counted), its type (8 bits) and its fields, all
/// little-endian; strings end with a zero byte, truth values take a byte.
namespace opal {

inline constexpr std::uint16_t tev_default_port = 14158;

struct TevAddress {
    std::string host = "127.0.0.1";
    std::uint16_t port = tev_default_port;
};

/// "host", "host:port", ":port" or "" (this machine, the viewer's usual port). Throws InputError.
TevAddress parse_tev_address(const std::string& text);

using TevPacket = std::vector<char>;

/// An image of the given name, replacing one that is there.
TevPacket tev_create_image(const std::string& name, int width, int height, std::span<const std::string> channels);
/// Whole rows [y, y + height) of all channels; `pixels` is interleaved.
TevPacket tev_update_image(const std::string& name, int y, int width, int height, std::span<const std::string> channels,
                           std::span<const float> pixels);
TevPacket tev_close_image(const std::string& name);

/// A connection to a viewer. Nothing about it ever throws or raises a signal: a viewer that is not there, closes or hangs makes
/// the connection dead, and sending does nothing from then on.
class TevConnection {
  public:
    /// Waits `timeout_s` at most.
    explicit TevConnection(const TevAddress& address, double timeout_s = 2.0);
    ~TevConnection();
    TevConnection(const TevConnection&) = delete;
    TevConnection& operator=(const TevConnection&) = delete;

    bool alive() const { return socket_ >= 0; }
    /// Whether all of it was handed over.
    bool send(const TevPacket& packet);

  private:
    void close();

    int socket_ = -1;
};

}  // namespace opal
