// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace opal {

/// The allowed values of a number. NaN is never allowed.
struct NumberRange {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool min_excluded = false;

    static NumberRange any() { return {-1.0e30, 1.0e30, false}; }
    static NumberRange positive(double max = 1.0e30) { return {0.0, max, true}; }
    static NumberRange from_zero(double max = 1.0e30) { return {0.0, max, false}; }
    static NumberRange between(double min, double max) { return {min, max, false}; }

    bool contains(double value) const;
    std::string describe() const;
};

/// One table of a TOML file. Every read names a key, its default and what is allowed; `finish()` rejects the keys nobody asked
/// for. All failures are InputError with file:line:column, what was wrong and what is allowed.
class TomlSection {
  public:
    TomlSection(const toml::table* table, std::string name, std::string file);

    bool has(const std::string& key) const;
    bool is_array(const std::string& key) const;
    bool is_text(const std::string& key) const;
    double number(const std::string& key, double fallback, const NumberRange& range);
    std::int64_t integer(const std::string& key, std::int64_t fallback, std::int64_t min, std::int64_t max);
    bool boolean(const std::string& key, bool fallback);
    std::string text(const std::string& key, const std::string& fallback);
    std::string choice(const std::string& key, const std::string& fallback, const std::vector<std::string>& allowed);
    /// Three numbers; a single number stands for all three where `scalar_allowed`.
    std::array<double, 3> vector3(const std::string& key, const std::array<double, 3>& fallback, const NumberRange& range,
                                  bool scalar_allowed = false);
    /// Exactly `count` integers.
    std::vector<std::int64_t> integers(const std::string& key, std::size_t count);
    /// Any number of strings; an absent key reads as none.
    std::vector<std::string> texts(const std::string& key);
    std::vector<std::string> choices(const std::string& key, const std::vector<std::string>& allowed);
    /// A file's path; a relative one is relative to the file that holds the key (to the working folder for --set). Empty if
    /// absent.
    std::filesystem::path path(const std::string& key);
    /// A sub-table; an absent one reads as empty.
    TomlSection section(const std::string& key);
    /// An array of tables ([[key]]); an absent one reads as empty.
    std::vector<TomlSection> sections(const std::string& key);

    /// Throws for the first key that was never read.
    void finish() const;
    /// Throws InputError located at `key` (at the table if the key is absent).
    [[noreturn]] void fail(const std::string& key, const std::string& message) const;

  private:
    const toml::node* find(const std::string& key);
    std::string location_of(const std::string& key) const;
    std::string full_name(const std::string& key) const;

    const toml::table* table_;
    std::string name_;
    std::string file_;
    std::vector<std::string> known_keys_;
};

/// Pairs of keys of which a file may give one.
using ExclusiveKeys = std::vector<std::pair<std::string, std::string>>;

/// A parsed file with `--set key.path=value` overrides applied (value in TOML syntax; a bare word is a string; elements of an
/// array of tables are named by number: object.0.file=...).
class TomlDocument {
  public:
    /// An override of one of two `exclusive` keys takes the place of the other.
    TomlDocument(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                 const ExclusiveKeys& exclusive = {});
    /// From text rather than a file; `name` stands for the file in messages.
    TomlDocument(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                 const ExclusiveKeys& exclusive = {});

    TomlSection root() const { return {&table_, "", name_}; }

  private:
    std::string name_;
    toml::table table_;
};

}  // namespace opal
