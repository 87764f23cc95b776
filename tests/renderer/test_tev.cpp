// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <map>
#include <optional>
#include <thread>

#include "../formats/expect_error.h"
#include "renderer/host/live_view.h"

namespace opal {
namespace {

/// Reads the fields of a packet in their order.
class PacketReader {
  public:
    explicit PacketReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

    template <typename T>
    T number() {
        T value = {};
        if (at_ + sizeof(T) > bytes_.size()) {
            ADD_FAILURE() << "a packet ends early";
            return value;
        }
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    std::string text() {
        std::string value;
        while (const char c = number<char>()) value += c;
        return value;
    }
    std::size_t left() const { return bytes_.size() - at_; }

  private:
    std::vector<char> bytes_;
    std::size_t at_ = 0;
};

/// The pictures as a viewer would hold them, by name.
struct Viewer {
    struct Picture {
        int width = 0, height = 0;
        std::map<std::string, std::vector<float>> channels;
    };
    std::map<std::string, Picture> pictures;
    int packets = 0;

    void take(std::vector<char> bytes) {
        ++packets;
        PacketReader packet(std::move(bytes));
        switch (const char type = packet.number<char>()) {
            case 2:
                pictures.erase(packet.text());
                break;
            case 4:
                create(packet);
                break;
            case 6:
                update(packet);
                break;
            default:
                ADD_FAILURE() << "packet of type " << int(type);
        }
        EXPECT_EQ(packet.left(), 0u);
    }

    void create(PacketReader& packet) {
        packet.number<char>();
        Picture& picture = pictures[packet.text()];
        picture.width = packet.number<std::int32_t>();
        picture.height = packet.number<std::int32_t>();
        const int count = packet.number<std::int32_t>();
        for (int c = 0; c < count; ++c)
            picture.channels[packet.text()].resize(std::size_t(picture.width) * std::size_t(picture.height));
    }

    void update(PacketReader& packet) {
        packet.number<char>();
        Picture& picture = pictures.at(packet.text());
        const int count = packet.number<std::int32_t>();
        std::vector<std::string> names;
        for (int c = 0; c < count; ++c) names.push_back(packet.text());
        const int x0 = packet.number<std::int32_t>(), y0 = packet.number<std::int32_t>();
        const int width = packet.number<std::int32_t>(), height = packet.number<std::int32_t>();
        std::vector<std::int64_t> offsets, strides;
        for (int c = 0; c < count; ++c) offsets.push_back(packet.number<std::int64_t>());
        for (int c = 0; c < count; ++c) strides.push_back(packet.number<std::int64_t>());
        std::vector<float> data(packet.left() / sizeof(float));
        for (float& value : data) value = packet.number<float>();
        for (int c = 0; c < count; ++c)
            for (int i = 0; i < width * height; ++i)
                picture.channels.at(names[c]).at((y0 + i / width) * picture.width + x0 + i % width) =
                    data.at(offsets[c] + i * strides[c]);
    }
};

/// A viewer's end of the connection: takes one client and reads its packets till it goes, or hangs up after some of them.
class Server {
  public:
    explicit Server(int hang_up_after = -1) : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        EXPECT_EQ(::listen(listener_, 1), 0);
        socklen_t size = sizeof address;
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this, hang_up_after] { serve(hang_up_after); });
    }
    TevAddress address() const { return {"127.0.0.1", port_}; }
    /// What the client had sent when it went.
    const Viewer& finished() {
        thread_.join();
        ::close(listener_);
        return viewer_;
    }

  private:
    static std::optional<std::vector<char>> read_bytes(int client, std::size_t count) {
        std::vector<char> bytes(count);
        std::size_t got = 0;
        while (got < count) {
            const ssize_t part = ::recv(client, bytes.data() + got, count - got, 0);
            if (part <= 0) return std::nullopt;
            got += std::size_t(part);
        }
        return bytes;
    }
    void serve(int hang_up_after) {
        const int client = ::accept(listener_, nullptr, nullptr);
        while (viewer_.packets != hang_up_after) {
            const auto prefix = read_bytes(client, 4);
            if (!prefix) break;
            std::uint32_t size = 0;
            std::memcpy(&size, prefix->data(), 4);
            auto rest = read_bytes(client, size - 4);
            if (!rest) break;
            viewer_.take(std::move(*rest));
        }
        ::close(client);
    }

    int listener_;
    std::uint16_t port_ = 0;
    Viewer viewer_;
    std::thread thread_;
};

Image picture(int width, int height, float first) {
    Image image;
    image.width = width;
    image.height = height;
    image.channel_names = {"R", "G", "B", "sample_count"};
    for (int i = 0; i < width * height * 4; ++i) image.pixels.push_back(first + float(i));
    return image;
}

TEST(Tev, TheViewerHoldsTheLastPicture) {
    Server server;
    const Image last = picture(700, 300, -5.5f);
    {
        LiveView view(server.address(), "gem.exr", [&] { return last; });
        EXPECT_TRUE(view.connected());
    }
    const Viewer& viewer = server.finished();
    ASSERT_EQ(viewer.pictures.size(), 1u);
    const Viewer::Picture& shown = viewer.pictures.at("gem.exr");
    ASSERT_EQ(shown.width, 700);
    ASSERT_EQ(shown.height, 300);
    ASSERT_EQ(shown.channels.size(), 3u);
    for (const auto& [name, channel] : std::map<std::string, int>{{"R", 0}, {"G", 1}, {"B", 2}})
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 700; ++x) ASSERT_EQ(shown.channels.at(name)[y * 700 + x], last.pixel(x, y)[channel]) << name;
}

TEST(Tev, AViewerThatIsNotThereIsNoError) {
    const LiveView view({"127.0.0.1", 1}, "gem", [] { return picture(10, 10, 0.0f); });
    EXPECT_FALSE(view.connected());
}

/// It hangs up while pictures still come: no signal, no exception, and the connection is known to be dead.
TEST(Tev, AViewerThatVanishesIsForgotten) {
    Server server(2);
    const LiveView view(server.address(), "gem", [] { return picture(1000, 1000, 0.0f); });
    for (int i = 0; i < 600 && view.connected(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(view.connected());
    server.finished();
}

/// It stays but takes nothing: sending gives up after a while.
TEST(Tev, AViewerThatHangsIsForgotten) {
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(listener, 1), 0);
    ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
    TevConnection connection({"127.0.0.1", ntohs(address.sin_port)});
    EXPECT_TRUE(connection.alive());
    EXPECT_FALSE(connection.send(TevPacket(std::size_t(64) << 20)));
    EXPECT_FALSE(connection.alive());
    ::close(listener);
}

TEST(Tev, ClosingAPicture) {
    Viewer viewer;
    const std::string channels[] = {"R"};
    const auto take = [&](const TevPacket& packet) {
        std::uint32_t size = 0;
        std::memcpy(&size, packet.data(), 4);
        EXPECT_EQ(size, packet.size());
        viewer.take({packet.begin() + 4, packet.end()});
    };
    take(tev_create_image("a", 2, 1, channels));
    EXPECT_EQ(viewer.pictures.count("a"), 1u);
    take(tev_close_image("a"));
    EXPECT_EQ(viewer.pictures.count("a"), 0u);
}

TEST(Tev, Addresses) {
    EXPECT_EQ(parse_tev_address("").host, "127.0.0.1");
    EXPECT_EQ(parse_tev_address("").port, 14158);
    EXPECT_EQ(parse_tev_address("box").host, "box");
    EXPECT_EQ(parse_tev_address("box:99").port, 99);
    EXPECT_EQ(parse_tev_address(":99").host, "127.0.0.1");
    for (const char* bad : {"box:", "box:0", "box:65536", "box:1x", "box:-3"})
        EXPECT_INPUT_ERROR(parse_tev_address(bad), "expected host, host:port or :port");
}

}  // namespace
}  // namespace opal
