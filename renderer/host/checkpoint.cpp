// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/checkpoint.h"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/content_hash.h"

namespace opal {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as memory holds it");
static_assert(std::is_trivially_copyable_v<PathCounters> && std::is_trivially_copyable_v<SpectrumTotals>);

constexpr char magic[8] = {'O', 'P', 'A', 'L', 'C', 'K', 'P', 'T'};
constexpr std::uint32_t format_version = 2;
constexpr std::uint32_t max_header_bytes = 1 << 24;

class CheckpointOutput {
  public:
    explicit CheckpointOutput(const AtomicFile& file) : path_(file.path()), stream_(file.temporary_path(), std::ios::binary) {}

    void write(const void* data, std::size_t size) {
        hash_.add(data, size);
        stream_.write(static_cast<const char*>(data), std::streamsize(size));
    }
    template <typename T>
    void write(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        write(&value, sizeof value);
    }
    /// Of all that is written so far.
    void write_checksum() { write(hash_.value()); }
    void finish() {
        write_checksum();
        stream_.close();
        if (!stream_) throw SystemError(fmt::format("{}: writing failed: {}", path_.string(), std::strerror(errno)));
    }
    bool good() const { return stream_.good(); }

  private:
    std::filesystem::path path_;
    std::ofstream stream_;
    ContentHash hash_;
};

class CheckpointInput {
  public:
    explicit CheckpointInput(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {
        if (!stream_) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    }

    void read(void* data, std::size_t size) {
        if (!stream_.read(static_cast<char*>(data), std::streamsize(size))) fail("it ends too early");
        hash_.add(data, size);
    }
    template <typename T>
    T read() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        read(&value, sizeof value);
        return value;
    }
    /// Throws where what was read so far is not what was written.
    void check(const char* part) {
        const std::uint64_t expected = hash_.value();
        if (read<std::uint64_t>() != expected) fail(fmt::format("it is damaged: the checksum does not fit its {}", part));
    }
    void finish() {
        check("content");
        if (stream_.peek() != std::ifstream::traits_type::eof()) fail("it goes on after its end");
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw InputError(fmt::format("{}: not a whole checkpoint: {}", path_.string(), why));
    }

  private:
    std::filesystem::path path_;
    std::ifstream stream_;
    ContentHash hash_;
};

nlohmann::json layout_of(const Film& film) {
    const PixelWindow& window = film.window();
    return {{"window", {window.x0, window.y0, window.x1, window.y1}},
            {"sums_per_pixel", film.sums_per_pixel()},
            {"block_edge", block_edge},
            {"first_sample", film.first_sample()},
            {"counters_bytes", sizeof(PathCounters)},
            {"totals_bytes", sizeof(SpectrumTotals)}};
}

nlohmann::json read_header(CheckpointInput& input) {
    char found[sizeof magic];
    input.read(found, sizeof found);
    if (std::memcmp(found, magic, sizeof magic) != 0) input.fail("it does not begin like one");
    const auto version = input.read<std::uint32_t>();
    if (version != format_version)
        input.fail(fmt::format("its format is version {}, this program's {} (or it is damaged)", version, format_version));
    const auto length = input.read<std::uint32_t>();
    if (length > max_header_bytes) input.fail("its header is damaged");
    std::string text(length, '\0');
    input.read(text.data(), text.size());
    input.check("header");
    nlohmann::json header = nlohmann::json::parse(text, nullptr, false);
    if (!header.is_object() || !header.contains("layout") || !header["fingerprint"].is_string() ||
        !header["render_s"].is_number())
        input.fail("its header is damaged");
    return header;
}

/// A block as it lies in the file.
struct BlockRecord {
    std::uint32_t end_sample;
    std::uint32_t settled;
    float luminance_noise, chroma_noise;
    PathCounters counters;
    SpectrumTotals totals;
};

void write_block(CheckpointOutput& output, const Film& film, int index, std::vector<double>& sums,
                 std::vector<std::uint32_t>& counts) {
    const FilmBlock& block = film.block(index);
    const PixelWindow window = film.block_window(index);
    sums.clear();
    counts.clear();
    BlockRecord record = {};
    {
        const std::scoped_lock lock(block.lock);
        record.end_sample = block.end_sample;
        record.settled = block.settled ? 1 : 0;
        record.luminance_noise = block.luminance_noise;
        record.chroma_noise = block.chroma_noise;
        record.counters = block.counters;
        record.totals = block.totals;
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                const std::uint32_t pixel = std::uint32_t(y * film.width() + x);
                const std::span<const double> pixel_sums = film.sums(pixel);
                sums.insert(sums.end(), pixel_sums.begin(), pixel_sums.end());
                counts.push_back(film.samples(pixel));
            }
    }
    output.write(record);
    output.write(sums.data(), sums.size() * sizeof(double));
    output.write(counts.data(), counts.size() * sizeof(std::uint32_t));
}

void read_block(CheckpointInput& input, Film& film, int index) {
    FilmBlock& block = film.block(index);
    const PixelWindow window = film.block_window(index);
    const auto record = input.read<BlockRecord>();
    block.end_sample = record.end_sample;
    block.settled = record.settled != 0;
    block.luminance_noise = record.luminance_noise;
    block.chroma_noise = record.chroma_noise;
    block.counters = record.counters;
    block.totals = record.totals;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<double> sums = film.sums(std::uint32_t(y * film.width() + x));
            input.read(sums.data(), sums.size_bytes());
        }
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            film.set_samples(std::uint32_t(y * film.width() + x), input.read<std::uint32_t>());
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Film& film, const CheckpointHeader& header) {
    const std::string text =
        nlohmann::json{{"fingerprint", header.fingerprint}, {"render_s", header.render_s}, {"layout", layout_of(film)}}.dump();
    AtomicFile file(path);
    CheckpointOutput output(file);
    output.write(magic, sizeof magic);
    output.write(format_version);
    output.write(std::uint32_t(text.size()));
    output.write(text.data(), text.size());
    output.write_checksum();
    std::vector<double> sums;
    std::vector<std::uint32_t> counts;
    for (int b = 0; b < film.num_blocks() && output.good(); ++b) write_block(output, film, b, sums, counts);
    // After the blocks: while none of them has more samples than the floor is taken at, it may still be unknown.
    output.write(film.noise_floor());
    output.finish();
    file.commit();
}

CheckpointHeader read_checkpoint_header(const std::filesystem::path& path) {
    CheckpointInput input(path);
    nlohmann::json header = read_header(input);
    return {header["fingerprint"], header["render_s"]};
}

void read_checkpoint(const std::filesystem::path& path, Film& film) {
    CheckpointInput input(path);
    if (read_header(input)["layout"] != layout_of(film)) input.fail("its film is laid out otherwise");
    for (int b = 0; b < film.num_blocks(); ++b) read_block(input, film, b);
    film.set_noise_floor(input.read<double>());
    input.finish();
}

}  // namespace opal
