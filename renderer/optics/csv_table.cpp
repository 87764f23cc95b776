// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/csv_table.h"

#include <fmt/format.h>

#include <cstdio>

#include "formats/atomic_file.h"
#include "formats/error.h"

namespace opal {

void CsvTable::add_row(const std::vector<double>& row) {
    text_ += fmt::format("{:.10g}\n", fmt::join(row, ","));
}

void CsvTable::add_row(const std::vector<double>& row, const std::string& last) {
    text_ += fmt::format("{:.10g},{}\n", fmt::join(row, ","), last);
}

void write_csv(const CsvTable& table, const std::filesystem::path& output) {
    if (!output.empty()) return write_text_file(output, table.text());
    const std::string& text = table.text();
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw SystemError("standard output: writing failed");
}

}  // namespace opal
