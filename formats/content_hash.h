// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace opal {

/// 64-bit hash of a sequence of bytes, to notice that they are others than before (damage, an edited file; not malice): words are
/// mixed in by multiplication and rotation, the end by the finalizer of MurmurHash3 (Appleby 2011). Depends on the bytes alone,
/// not on how they are handed over.
class ContentHash {
  public:
    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        size_ += size;
        for (; filled_ == 0 && size >= sizeof word_; bytes += sizeof word_, size -= sizeof word_) {
            std::memcpy(word_, bytes, sizeof word_);
            mix();
        }
        while (size > 0) {
            const std::size_t taken = size < sizeof word_ - filled_ ? size : sizeof word_ - filled_;
            std::memcpy(word_ + filled_, bytes, taken);
            filled_ += taken;
            bytes += taken;
            size -= taken;
            if (filled_ == sizeof word_) mix();
        }
    }

    std::uint64_t value() const {
        ContentHash end = *this;
        if (end.filled_ > 0) {
            std::memset(end.word_ + end.filled_, 0, sizeof end.word_ - end.filled_);
            end.mix();
        }
        std::uint64_t h = end.state_ ^ size_;
        h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
        h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
        return h ^ (h >> 33);
    }

  private:
    void mix() {
        std::uint64_t word;
        std::memcpy(&word, word_, sizeof word);
        state_ = std::rotl(state_ ^ (word * 0x9E3779B97F4A7C15u), 29) * 0xD1342543DE82EF95u;
        filled_ = 0;
    }

    std::uint64_t state_ = 0x243F6A8885A308D3u;
    std::uint64_t size_ = 0;
    unsigned char word_[8] = {};
    std::size_t filled_ = 0;
};

}  // namespace opal
