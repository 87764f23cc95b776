// SPDX-License-Identifier: Apache-2.0
#include "formats/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "formats/error.h"
#include "formats/text.h"

namespace opal {
namespace {

constexpr const char* override_source = "--set ";

std::string describe_location(const toml::source_region& source, const std::string& file) {
    const std::string path = source.path ? *source.path : file;
    if (path.starts_with(override_source)) return path;
    return fmt::format("{}:{}:{}", path, source.begin.line, source.begin.column);
}

std::string describe_type(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

std::string read_whole_file(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw InputError(fmt::format("{}: no such file", path.string()));
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("{}: is {}, not a file", path.string(),
                                     std::filesystem::is_directory(path, error) ? "a folder" : "a device"));
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
    return text.str();
}

bool is_array_index(std::string_view text) {
    return !text.empty() && text.size() < 10 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The value of an override as a one-key document, so that its node carries the override's own text as its source.
toml::table parse_override_value(const std::string& assignment, const std::string& value) {
    const std::string source = override_source + assignment;
    try {
        return toml::parse("value = " + value, source);
    } catch (const toml::parse_error&) {
        // A bare word is a string; anything that needs quoting or escapes is not a word and stays an error.
        if (value.empty() || value.find_first_of("\"'\\\n[]{}=") != std::string::npos)
            throw InputError(fmt::format("{}: '{}' is not a TOML value", source, value));
        return toml::parse("value = \"" + value + "\"", source);
    }
}

void apply_override(toml::table& root, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError(fmt::format("{}{}: expected key=value, for example grains.num_sites=1000", override_source, assignment));
    std::vector<std::string> parts;
    std::istringstream key_stream(assignment.substr(0, equals));
    for (std::string part; std::getline(key_stream, part, '.');) parts.push_back(part);

    toml::table value_table = parse_override_value(assignment, assignment.substr(equals + 1));
    toml::node* node = &root;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        if (toml::array* array = node->as_array()) {
            const std::size_t index = is_array_index(parts[i]) ? std::stoul(parts[i]) : array->size();
            if (index >= array->size())
                throw InputError(fmt::format("{}{}: there are {} entries; '{}' is not one of 0..{}", override_source, assignment,
                                             array->size(), parts[i], array->empty() ? 0 : array->size() - 1));
            node = &(*array)[index];
            continue;
        }
        toml::table* table = node->as_table();
        if (!table) throw InputError(fmt::format("{}{}: '{}' is not in a table", override_source, assignment, parts[i]));
        if (!table->contains(parts[i])) table->insert(parts[i], toml::table{});
        node = table->get(parts[i]);
    }
    toml::table* table = node->as_table();
    if (!table) throw InputError(fmt::format("{}{}: '{}' is not in a table", override_source, assignment, parts.back()));
    // Extracting keeps the node's source region; insert_or_assign of a copy would drop it.
    toml::node* value = value_table.get("value");
    value->visit([&](auto& concrete) { table->insert_or_assign(parts.back(), std::move(concrete)); });
}

void erase_key(toml::table& root, const std::string& dotted_key) {
    const std::size_t dot = dotted_key.rfind('.');
    const toml::node_view<toml::node> parent =
        dot == std::string::npos ? toml::node_view<toml::node>(root) : root.at_path(dotted_key.substr(0, dot));
    if (toml::table* table = parent.as_table()) table->erase(dotted_key.substr(dot == std::string::npos ? 0 : dot + 1));
}

}  // namespace

bool NumberRange::contains(double value) const {
    return std::isfinite(value) && (min_excluded ? value > min : value >= min) && value <= max;
}

std::string NumberRange::describe() const {
    const bool bounded_below = min > -1.0e30, bounded_above = max < 1.0e30;
    if (!bounded_below && !bounded_above) return "any finite number";
    if (!bounded_above) return fmt::format("{} {:g}", min_excluded ? "greater than" : "at least", min);
    if (!bounded_below) return fmt::format("at most {:g}", max);
    return fmt::format("{}{:g} to {:g}", min_excluded ? "above " : "", min, max);
}

TomlSection::TomlSection(const toml::table* table, std::string name, std::string file)
    : table_(table), name_(std::move(name)), file_(std::move(file)) {}

std::string TomlSection::full_name(const std::string& key) const {
    return name_.empty() ? key : name_ + "." + key;
}

std::string TomlSection::location_of(const std::string& key) const {
    if (!table_) return file_;
    const toml::node* node = table_->get(key);
    return describe_location(node ? node->source() : table_->source(), file_);
}

void TomlSection::fail(const std::string& key, const std::string& message) const {
    throw InputError(fmt::format("{}: {}: {}", location_of(key), full_name(key), message));
}

const toml::node* TomlSection::find(const std::string& key) {
    known_keys_.push_back(key);
    return table_ ? table_->get(key) : nullptr;
}

bool TomlSection::has(const std::string& key) const {
    return table_ && table_->contains(key);
}

bool TomlSection::is_array(const std::string& key) const {
    return has(key) && table_->get(key)->is_array();
}

bool TomlSection::is_text(const std::string& key) const {
    return has(key) && table_->get(key)->is_string();
}

namespace {

/// Of a number; whole ones beyond 2^53 are rounded.
double as_double(const toml::node& node) {
    // Minus zero becomes zero: written as "-0" it would be read again as the integer 0, and a scene would differ from itself.
    return node.is_integer() ? static_cast<double>(*node.value<std::int64_t>()) : *node.value<double>() + 0.0;
}

}  // namespace

double TomlSection::number(const std::string& key, double fallback, const NumberRange& range) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_number()) fail(key, fmt::format("expected a number ({}), found {}", range.describe(), describe_type(*node)));
    const double value = as_double(*node);
    if (!range.contains(value)) fail(key, fmt::format("{:g} is out of range; allowed: {}", value, range.describe()));
    return value;
}

std::int64_t TomlSection::integer(const std::string& key, std::int64_t fallback, std::int64_t min, std::int64_t max) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_integer()) fail(key, fmt::format("expected an integer ({} to {}), found {}", min, max, describe_type(*node)));
    const std::int64_t value = node->value<std::int64_t>().value();
    if (value < min || value > max) fail(key, fmt::format("{} is out of range; allowed: {} to {}", value, min, max));
    return value;
}

bool TomlSection::boolean(const std::string& key, bool fallback) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_boolean()) fail(key, "expected true or false, found " + describe_type(*node));
    return node->value<bool>().value();
}

std::string TomlSection::text(const std::string& key, const std::string& fallback) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_string()) fail(key, "expected a string, found " + describe_type(*node));
    return node->value<std::string>().value();
}

std::string TomlSection::choice(const std::string& key, const std::string& fallback, const std::vector<std::string>& allowed) {
    const std::string value = text(key, fallback);
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
        fail(key, fmt::format("'{}' is not known; allowed: {}{}", value, join(allowed), did_you_mean(value, allowed)));
    return value;
}

std::array<double, 3> TomlSection::vector3(const std::string& key, const std::array<double, 3>& fallback,
                                           const NumberRange& range, bool scalar_allowed) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    const auto checked = [&](const toml::node& element) {
        if (!element.is_number()) fail(key, "expected numbers, found " + describe_type(element));
        const double value = as_double(element);
        if (!range.contains(value)) fail(key, fmt::format("{:g} is out of range; allowed: {}", value, range.describe()));
        return value;
    };
    if (scalar_allowed && node->is_number()) {
        const double value = checked(*node);
        return {value, value, value};
    }
    const toml::array* array = node->as_array();
    if (!array || array->size() != 3)
        fail(key, fmt::format("expected {}[x, y, z], found {}", scalar_allowed ? "one number or " : "",
                              array ? fmt::format("{} elements", array->size()) : describe_type(*node)));
    return {checked((*array)[0]), checked((*array)[1]), checked((*array)[2])};
}

std::vector<std::int64_t> TomlSection::integers(const std::string& key, std::size_t count) {
    const toml::node* node = find(key);
    std::vector<std::int64_t> values;
    const toml::array* array = node ? node->as_array() : nullptr;
    if (!array || array->size() != count)
        fail(key, fmt::format("expected an array of {} integers, found {}", count,
                              array  ? fmt::format("{} elements", array->size())
                              : node ? describe_type(*node)
                                     : "nothing"));
    for (const toml::node& element : *array) {
        if (!element.is_integer()) fail(key, "expected integers, found " + describe_type(element));
        values.push_back(element.value<std::int64_t>().value());
    }
    return values;
}

std::vector<std::string> TomlSection::texts(const std::string& key) {
    const toml::node* node = find(key);
    std::vector<std::string> values;
    if (!node) return values;
    const toml::array* array = node->as_array();
    if (!array) fail(key, "expected an array of strings, found " + describe_type(*node));
    for (const toml::node& element : *array) {
        if (!element.is_string()) fail(key, "expected strings, found " + describe_type(element));
        values.push_back(element.value<std::string>().value());
    }
    return values;
}

std::vector<std::string> TomlSection::choices(const std::string& key, const std::vector<std::string>& allowed) {
    const std::vector<std::string> values = texts(key);
    for (const std::string& value : values)
        if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
            fail(key, fmt::format("'{}' is not known; allowed: {}{}", value, join(allowed), did_you_mean(value, allowed)));
    return values;
}

std::filesystem::path TomlSection::path(const std::string& key) {
    const std::filesystem::path value = text(key, "");
    if (value.empty() || value.is_absolute()) return value;
    const toml::source_region& source = table_->get(key)->source();
    const std::string holder = source.path ? *source.path : file_;
    if (holder.starts_with(override_source)) return value;
    return std::filesystem::path(holder).parent_path() / value;
}

TomlSection TomlSection::section(const std::string& key) {
    const toml::node* node = find(key);
    if (node && !node->is_table()) fail(key, "expected a table, found " + describe_type(*node));
    return {node ? node->as_table() : nullptr, full_name(key), file_};
}

std::vector<TomlSection> TomlSection::sections(const std::string& key) {
    const toml::node* node = find(key);
    std::vector<TomlSection> found;
    if (!node) return found;
    const toml::array* array = node->as_array();
    if (!array) fail(key, fmt::format("expected tables written as [[{}]], found {}", key, describe_type(*node)));
    for (std::size_t i = 0; i < array->size(); ++i) {
        const toml::table* table = (*array)[i].as_table();
        if (!table) fail(key, fmt::format("expected tables written as [[{}]], found {}", key, describe_type((*array)[i])));
        found.emplace_back(table, fmt::format("{}.{}", full_name(key), i), file_);
    }
    return found;
}

void TomlSection::finish() const {
    if (!table_) return;
    for (auto&& [key, node] : *table_) {
        const std::string name(key.str());
        if (std::find(known_keys_.begin(), known_keys_.end(), name) != known_keys_.end()) continue;
        std::vector<std::string> known = known_keys_;
        std::sort(known.begin(), known.end());
        const toml::source_region& source = key.source().begin ? key.source() : node.source();
        throw InputError(fmt::format("{}: unknown key '{}'{}{}", describe_location(source, file_), full_name(name),
                                     did_you_mean(name, known), known.empty() ? "" : " (known here: " + join(known) + ")"));
    }
}

TomlDocument::TomlDocument(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                           const ExclusiveKeys& exclusive)
    : TomlDocument(read_whole_file(file), file.string(), overrides, exclusive) {}

TomlDocument::TomlDocument(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                           const ExclusiveKeys& exclusive)
    : name_(name) {
    try {
        table_ = toml::parse(text, name_);
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}: {}", describe_location(error.source(), name_), error.description()));
    }
    for (const std::string& assignment : overrides) {
        apply_override(table_, assignment);
        for (const auto& [first, second] : exclusive) {
            if (assignment.starts_with(first + "=")) erase_key(table_, second);
            if (assignment.starts_with(second + "=")) erase_key(table_, first);
        }
    }
}

}  // namespace opal
