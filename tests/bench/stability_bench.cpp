// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability_bench.h"

#include <fmt/format.h>

#include <fstream>

#include "bench_chart.h"
#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/opal_asset.h"
#include "stability_cells.h"
#include "stability_media.h"
#include "stability_percolation.h"
#include "stability_planes.h"
#include "stability_spectra.h"

namespace opal {
namespace {

using AddRows = void (*)(bool quick, StabilityRows& rows);
constexpr AddRows cases[] = {add_weight_rows,   add_far_rows,         add_grazing_rows, add_ewald_rows,
                             add_zone_rows,     add_percolation_rows, add_depth_rows,   add_majorant_rows,
                             add_spectrum_rows, add_bounce_rows,      add_voxel_rows};

/// Doubled quotes within quotes, as CSV has it.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

}  // namespace

void bench_stability(const std::filesystem::path& folder, bool quick) {
    initialize_openvdb();
    std::filesystem::create_directories(folder);
    StabilityRows rows;
    for (const AddRows add : cases) {
        const Stopwatch watch;
        const std::size_t first = rows.size();
        add(quick, rows);
        for (std::size_t n = first; n < rows.size(); ++n)
            fmt::print("{:<20} {:<46} {:<36} {:>9.4g}: {:>10.4g} +- {:<8.2g} {}\n", rows[n].test_case, rows[n].method,
                       rows[n].input, rows[n].value, rows[n].error.mean, rows[n].error.standard_error, rows[n].unit);
        fmt::print("{} in {:.1f} s\n", rows[first].test_case, watch.seconds());
        std::fflush(stdout);
    }
    const std::filesystem::path csv_path = folder / "stability.csv";
    AtomicFile file(csv_path);
    std::ofstream csv(file.temporary_path());
    csv << "case,method,input,value,error,standard_error,unit,outcome,kept_by\n";
    for (const StabilityRow& row : rows)
        csv << fmt::format("{},{},{},{:.6g},{:.6g},{:.3g},{},{},{}\n", quoted(row.test_case), quoted(row.method),
                           quoted(row.input), row.value, row.error.mean, row.error.standard_error, quoted(row.unit),
                           quoted(row.outcome), quoted(row.kept_by));
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", csv_path.string()));
    file.commit();
    draw_chart("plot_stability.py", csv_path);
}

}  // namespace opal
