// SPDX-License-Identifier: GPL-3.0-or-later
#include "color_bench.h"

#include <fmt/format.h>

#include <fstream>

#include "../renderer/color_round_trip.h"
#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/random.h"

namespace opal {
namespace {

struct Method {
    const char* name;
    SpectrumTablesData tables;
};

std::vector<Method> methods() {
    std::vector<Method> result;
    const auto add = [&](const char* name, Upsampling upsampling) {
        SpectrumTableOptions options;
        options.upsampling = upsampling;
        result.push_back({name, make_spectrum_tables(options)});
    };
    add("jakob-hanika", Upsampling::jakob_hanika);
    add("smits", Upsampling::smits);
    add("basis", Upsampling::basis);
    return result;
}

/// A .csv that appears whole or not at all.
class CsvWriter {
  public:
    CsvWriter(const std::filesystem::path& path, const std::string& header)
        : path_(path), file_(path), stream_(file_.temporary_path()) {
        stream_ << header << '\n';
    }
    void row(const std::string& text) { stream_ << text << '\n'; }
    void commit() {
        stream_.close();
        if (!stream_) throw SystemError(fmt::format("{}: writing failed", path_.string()));
        file_.commit();
    }

  private:
    std::filesystem::path path_;
    AtomicFile file_;
    std::ofstream stream_;
};

Rgb3d widened(Rgb color) {
    return {double(color.r), double(color.g), double(color.b)};
}

bool strictly_inside(Rgb color) {
    return min_of(color.r, min_of(color.g, color.b)) > 0.0f && max_of(color.r, max_of(color.g, color.b)) < 1.0f;
}

void write_round_trip(const std::filesystem::path& folder) {
    CsvWriter summary(folder / "upsampling_round_trip.csv", "method,colors,mean_delta_e,percentile_95_delta_e,max_delta_e");
    CsvWriter each(folder / "upsampling_round_trip_colors.csv", "method,r,g,b,delta_e");
    const std::vector<Rgb> cube = srgb_cube(33);
    for (const Method& method : methods()) {
        std::vector<double> all, inside;
        for (const Rgb color : cube) {
            const double error =
                delta_e_76(lab_of(method.tables, reflectance_table(method.tables, color)), lab_of(widened(color)));
            all.push_back(error);
            if (strictly_inside(color)) inside.push_back(error);
            each.row(fmt::format("{},{:.6g},{:.6g},{:.6g},{:.4g}", method.name, color.r, color.g, color.b, error));
        }
        for (const auto& [name, errors] : {std::pair("all", all), std::pair("inside", inside)}) {
            const ErrorStatistics s = statistics_of(errors);
            const std::string line = fmt::format("{},{},{:.4g},{:.4g},{:.4g}", method.name, name, s.mean, s.percentile_95, s.max);
            summary.row(line);
            fmt::print("round trip: {}\n", line);
        }
    }
    summary.commit();
    each.commit();
}

Rgb3d product(Rgb3d a, Rgb3d b) {
    return {a.r * b.r, a.g * b.g, a.b * b.b};
}

/// Errors after 1, 2 ... multiplications of `color` by `factor`.
std::vector<double> multiplication_errors(const SpectrumTablesData& tables, Rgb color, Rgb factor, int multiplications) {
    ReflectanceTable spectrum = reflectance_table(tables, color);
    const ReflectanceTable other = reflectance_table(tables, factor);
    Rgb3d rgb = widened(color);
    std::vector<double> errors;
    for (int n = 1; n <= multiplications; ++n) {
        for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= other[i];
        rgb = product(rgb, widened(factor));
        errors.push_back(delta_e_76(lab_of(tables, spectrum), lab_of(rgb)));
    }
    return errors;
}

void write_multiplication(const std::filesystem::path& folder) {
    constexpr int multiplications = 10;
    CsvWriter csv(folder / "multiplication.csv", "method,factor,multiplications,mean_delta_e,percentile_95_delta_e");
    const std::vector<Rgb> cube = srgb_cube(17);
    for (const Method& method : methods())
        for (const bool by_itself : {true, false}) {
            std::vector<std::vector<double>> errors(multiplications);
            for (std::size_t i = 0; i < cube.size(); ++i) {
                const RandomBlock block = random_block(1, RandomStream::bench, i, 0);
                const Rgb other = cube[std::size_t(uniform_double(block.value[0], block.value[1]) * double(cube.size()))];
                const std::vector<double> row =
                    multiplication_errors(method.tables, cube[i], by_itself ? cube[i] : other, multiplications);
                for (std::size_t n = 0; n < row.size(); ++n) errors[n].push_back(row[n]);
            }
            for (std::size_t n = 0; n < errors.size(); ++n) {
                const ErrorStatistics s = statistics_of(errors[n]);
                const std::string line = fmt::format("{},{},{},{:.4g},{:.4g}", method.name, by_itself ? "itself" : "another",
                                                     n + 1, s.mean, s.percentile_95);
                csv.row(line);
                fmt::print("multiplication: {}\n", line);
            }
        }
    csv.commit();
}

}  // namespace

void bench_color(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write_round_trip(folder);
    write_multiplication(folder);
}

}  // namespace opal
