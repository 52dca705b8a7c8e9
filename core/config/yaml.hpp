// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"

namespace headland::config {

/// A node of a parsed YAML file: the value, and where it stands. Cheap to copy.
class Node {
 public:
  /// Parses a file. A file that is absent, unreadable or not YAML is an Error with its line.
  static Result<Node> load(const std::filesystem::path& file);
  /// Parses a text; `name` stands for the file in errors.
  static Result<Node> parse(const std::string& text, const std::string& name);

  bool is_map() const;
  bool is_sequence() const;
  bool is_scalar() const;
  std::vector<std::string> keys() const;  ///< of a map, in file order
  std::optional<Node> child(std::string_view key) const;
  std::vector<Node> items() const;    ///< of a sequence
  const std::string& scalar() const;  ///< the text of a scalar
  Location where() const;

  /// Sets `dotted.key` (numbers index sequences) to a YAML text, creating maps on the way: `--set`.
  Result<void> set(std::string_view dotted_key, const std::string& yaml_value);

 private:
  struct Impl;
  explicit Node(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

namespace internal {
Result<double> to_double(const Node& node, Range range);
Result<std::int64_t> to_int(const Node& node, Range range);
Result<bool> to_bool(const Node& node);
Result<std::string> to_text(const Node& node);
tl::unexpected<Error> unknown_key(const Node& map, const std::string& key,
                                  const std::vector<std::string>& known);
tl::unexpected<Error> missing_key(const Node& map, std::string_view key, std::string_view doc);
tl::unexpected<Error> repeated_key(const Node& map, const std::string& key);
tl::unexpected<Error> not_a_map(const Node& node);
tl::unexpected<Error> not_a_sequence(const Node& node);
tl::unexpected<Error> unknown_name(const Node& node, const std::vector<std::string_view>& names);
}  // namespace internal

template <class T>
Result<void> read_into(const Node& node, T& value, Range range = {});

/// The visitor that fills a struct from a map; the first error stops it.
class Reader {
 public:
  explicit Reader(const Node& node) : node_(node) {}

  template <class T>
  void operator()(std::string_view key, T& value, Range range = {}, std::string_view doc = {}) {
    field(key, value, range, doc, false);
  }
  template <class T>
  void operator()(std::string_view key, T& value, std::string_view doc) {
    field(key, value, {}, doc, false);
  }
  template <class T>
  void required(std::string_view key, T& value, Range range = {}, std::string_view doc = {}) {
    field(key, value, range, doc, true);
  }
  template <class T>
  void required(std::string_view key, T& value, std::string_view doc) {
    field(key, value, {}, doc, true);
  }

  /// Errors of the members, then of keys that no member asked for.
  Result<void> finish() const {
    if (error_) return tl::unexpected<Error>(*error_);
    std::set<std::string> seen;
    for (const std::string& key : node_.keys()) {
      if (!seen.insert(key).second) return internal::repeated_key(node_, key);
      bool known = false;
      for (const std::string& k : known_) known = known || k == key;
      if (!known) return internal::unknown_key(node_, key, known_);
    }
    return {};
  }

 private:
  template <class T>
  void field(std::string_view key, T& value, Range range, std::string_view doc, bool required) {
    known_.emplace_back(key);
    if (error_) return;
    const auto child = node_.child(key);
    if (!child) {
      if (required) error_ = internal::missing_key(node_, key, doc).value();
      return;
    }
    if (auto read = read_into(*child, value, range); !read) error_ = std::move(read.error());
  }

  const Node& node_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
};

template <class T>
Result<void> read_into(const Node& node, T& value, Range range) {
  if constexpr (std::is_same_v<T, double>) {
    auto number = internal::to_double(node, range);
    if (!number) return tl::unexpected<Error>(number.error());
    value = *number;
  } else if constexpr (std::is_same_v<T, bool>) {
    auto flag = internal::to_bool(node);
    if (!flag) return tl::unexpected<Error>(flag.error());
    value = *flag;
  } else if constexpr (std::is_integral_v<T>) {
    auto number = internal::to_int(node, range);
    if (!number) return tl::unexpected<Error>(number.error());
    value = static_cast<T>(*number);
  } else if constexpr (std::is_same_v<T, std::string>) {
    auto text = internal::to_text(node);
    if (!text) return tl::unexpected<Error>(text.error());
    value = std::move(*text);
  } else if constexpr (std::is_enum_v<T>) {
    std::vector<std::string_view> names;
    for (const auto& [candidate, name] : EnumNames<T>::values) {
      if (node.is_scalar() && node.scalar() == name) {
        value = candidate;
        return {};
      }
      names.push_back(name);
    }
    return internal::unknown_name(node, names);
  } else if constexpr (IsOptional<T>::value) {
    typename T::value_type inner{};
    if (auto read = read_into(node, inner, range); !read) return read;
    value = std::move(inner);
  } else if constexpr (IsVector<T>::value) {
    value.clear();
    if constexpr (std::is_same_v<typename T::value_type, std::string>) {
      if (node.is_scalar()) {  // one name is a list of one
        value.push_back(node.scalar());
        return {};
      }
    }
    if (!node.is_sequence()) return internal::not_a_sequence(node);
    for (const Node& item : node.items()) {
      typename T::value_type element{};
      if (auto read = read_into(item, element, range); !read) return read;
      value.push_back(std::move(element));
    }
  } else {
    if (!node.is_map()) return internal::not_a_map(node);
    Reader reader(node);
    value.visit(reader);
    if (auto read = reader.finish(); !read) return read;
    if constexpr (requires { value.check(); }) {
      if (std::optional<Error> error = value.check()) {
        const Location where = node.where();
        error->where = Location{where.file, where.line,
                                where.key.empty()          ? error->where.key
                                : error->where.key.empty() ? where.key
                                                           : where.key + "." + error->where.key};
        return tl::unexpected<Error>(std::move(*error));
      }
    }
  }
  return {};
}

/// Reads a whole file into a struct; every key is known, in range, and present where required.
template <class T>
Result<T> load(const std::filesystem::path& file) {
  auto node = Node::load(file);
  if (!node) return tl::unexpected<Error>(node.error());
  T value{};
  if (auto read = read_into(*node, value); !read) return tl::unexpected<Error>(read.error());
  return value;
}

/// The visitor that writes a struct as YAML text, all members, in visiting order.
class Writer {
 public:
  template <class T>
  void operator()(std::string_view key, T& value, Range = {}, std::string_view = {}) {
    write(key, value);
  }
  template <class T>
  void operator()(std::string_view key, T& value, std::string_view) {
    write(key, value);
  }
  template <class T>
  void required(std::string_view key, T& value, Range = {}, std::string_view = {}) {
    write(key, value);
  }
  template <class T>
  void required(std::string_view key, T& value, std::string_view) {
    write(key, value);
  }
  const std::string& text() const { return text_; }

 private:
  static std::string quoted(const std::string& text);

  template <class T>
  static std::string scalar(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      return value ? "true" : "false";
    } else if constexpr (std::is_arithmetic_v<T>) {
      return fmt::format("{}", value);
    } else if constexpr (std::is_enum_v<T>) {
      return std::string(enum_name(value));
    } else {
      return quoted(value);
    }
  }

  template <class T>
  static constexpr bool is_struct() {
    return std::is_class_v<T> && !std::is_same_v<T, std::string> && !IsVector<T>::value &&
           !IsOptional<T>::value;
  }

  template <class T>
  void write(std::string_view key, T& value) {
    if constexpr (IsOptional<T>::value) {
      if (value) write(key, *value);
    } else if constexpr (IsVector<T>::value) {
      if (value.empty()) {
        line(key, "[]");
      } else if constexpr (is_struct<typename T::value_type>()) {
        line(key, "");
        for (auto& item : value) {
          Writer inner;
          item.visit(inner);
          nest(inner.text(), "  - ", "    ");
        }
      } else {
        std::string list;
        for (const auto& item : value) {
          list += (list.empty() ? "" : ", ") + scalar(static_cast<typename T::value_type>(item));
        }
        line(key, "[" + list + "]");
      }
    } else if constexpr (is_struct<T>()) {
      line(key, "");
      Writer inner;
      value.visit(inner);
      nest(inner.text(), "  ", "  ");
    } else {
      line(key, scalar(value));
    }
  }

  void line(std::string_view key, const std::string& value) {
    text_ += std::string(key) + ":" + (value.empty() ? "" : " " + value) + "\n";
  }
  void nest(const std::string& block, std::string_view first, std::string_view rest);

  std::string text_;
};

/// The effective configuration as YAML, defaults included.
template <class T>
std::string to_yaml(T value) {
  Writer writer;
  value.visit(writer);
  return writer.text();
}

}  // namespace headland::config
