// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// A table of numbers as comma-separated text: one header line, ten significant digits.
class CsvTable {
  public:
    explicit CsvTable(std::string header) : text_(std::move(header) + "\n") {}

    void add_row(const std::vector<double>& row);
    /// A row that ends in text.
    void add_row(const std::vector<double>& row, const std::string& last);
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

/// To a file, whole or not at all, or to standard output where `output` is empty. Throws InputError or SystemError.
void write_csv(const CsvTable& table, const std::filesystem::path& output);

}  // namespace opal
