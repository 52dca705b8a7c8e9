// SPDX-License-Identifier: Apache-2.0
#include "core/config/yaml.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "core/config/messages.hpp"

namespace headland::config {

struct Node::Impl {
  YAML::Node yaml;
  YAML::Node root;  // keeps the document alive, and is what set() changes
  std::string file;
  std::string key;
};

Result<Node> Node::parse(const std::string& text, const std::string& name) {
  try {
    YAML::Node yaml = YAML::Load(text);
    return Node(std::make_shared<Impl>(Impl{yaml, yaml, name, ""}));
  } catch (const YAML::Exception& e) {
    return fail(ErrorCode::kSyntax, "not valid YAML: " + e.msg, "correct the line",
                Location{name, e.mark.line + 1, ""});
  }
}

Result<Node> Node::load(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code)) {
    return fail(ErrorCode::kFileNotFound, "no such file", "check the path",
                Location{file.string(), 0, ""});
  }
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream) {
    return fail(ErrorCode::kFileNotFound, "the file cannot be read", "check its permissions",
                Location{file.string(), 0, ""});
  }
  return parse(text.str(), file.string());
}

bool Node::is_map() const { return impl_->yaml.IsMap(); }
bool Node::is_sequence() const { return impl_->yaml.IsSequence(); }
bool Node::is_scalar() const { return impl_->yaml.IsScalar(); }
const std::string& Node::scalar() const { return impl_->yaml.Scalar(); }

std::vector<std::string> Node::keys() const {
  std::vector<std::string> keys;
  if (!is_map()) return keys;
  for (const auto& entry : impl_->yaml) keys.push_back(entry.first.as<std::string>(""));
  return keys;
}

std::optional<Node> Node::child(std::string_view key) const {
  if (!is_map()) return std::nullopt;
  for (const auto& entry : impl_->yaml) {
    if (entry.first.IsScalar() && entry.first.Scalar() == key) {
      const std::string path =
          impl_->key.empty() ? std::string(key) : impl_->key + "." + std::string(key);
      return Node(std::make_shared<Impl>(Impl{entry.second, impl_->root, impl_->file, path}));
    }
  }
  return std::nullopt;
}

std::vector<Node> Node::items() const {
  std::vector<Node> items;
  for (std::size_t i = 0; is_sequence() && i < impl_->yaml.size(); ++i) {
    const std::string index = std::to_string(i);
    const std::string path = impl_->key.empty() ? index : impl_->key + "." + index;
    items.push_back(
        Node(std::make_shared<Impl>(Impl{impl_->yaml[i], impl_->root, impl_->file, path})));
  }
  return items;
}

Location Node::where() const {
  const YAML::Mark mark = impl_->yaml.Mark();
  return Location{impl_->file, mark.is_null() ? 0 : mark.line + 1, impl_->key};
}

Result<void> Node::set(std::string_view dotted_key, const std::string& yaml_value) {
  const Location where{"--set", 0, std::string(dotted_key)};
  try {
    const YAML::Node value = YAML::Load(yaml_value);
    YAML::Node at = impl_->yaml;
    std::string_view rest = dotted_key;
    while (true) {
      const std::size_t dot = rest.find('.');
      const std::string part(rest.substr(0, dot));
      if (part.empty())
        return fail(ErrorCode::kUnknownKey, "an empty part in the key", "write a.b.c=value", where);
      std::size_t index = 0;
      const auto parsed = std::from_chars(part.data(), part.data() + part.size(), index);
      const bool is_index = at.IsSequence();
      if (is_index && (parsed.ec != std::errc{} || parsed.ptr != part.data() + part.size() ||
                       index >= at.size())) {
        return fail(ErrorCode::kOutOfRange, "'" + part + "' is no index of this list",
                    "use 0 to " + std::to_string(static_cast<int>(at.size()) - 1), where);
      }
      if (dot == std::string_view::npos) {
        if (is_index)
          at[index] = value;
        else
          at[part] = value;
        return {};
      }
      // reset() rebinds the handle; assignment would overwrite the node it points to.
      at.reset(is_index ? at[index] : at[part]);
      rest.remove_prefix(dot + 1);
    }
  } catch (const YAML::Exception& e) {
    return fail(ErrorCode::kSyntax, "cannot be set: " + e.msg, "write key=value", where);
  }
}

namespace internal {
namespace {

// A scalar as messages show it: one line of printable characters, not too long.
std::string shown(const std::string& scalar) {
  constexpr std::size_t kLongest = 40;
  std::string text = scalar.substr(0, kLongest);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return "'" + text + (scalar.size() > kLongest ? "...'" : "'");
}

tl::unexpected<Error> wrong_type(const Node& node, std::string_view wanted) {
  const std::string got = node.is_map()           ? "a map"
                          : node.is_sequence()    ? "a list"
                          : node.scalar().empty() ? "nothing"
                                                  : shown(node.scalar());
  return fail(ErrorCode::kWrongType, got + " is not " + std::string(wanted),
              "write " + std::string(wanted), node.where());
}

std::string join(const auto& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

}  // namespace

Result<double> to_double(const Node& node, Range range) {
  if (!node.is_scalar()) return wrong_type(node, "a number");
  const std::string& text = node.scalar();
  double value = 0.0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size() ||
      !std::isfinite(value)) {
    return wrong_type(node, "a number");
  }
  if (value < range.min || value > range.max) {
    return fail(ErrorCode::kOutOfRange, text + " is out of range", allowed(range), node.where());
  }
  return value;
}

Result<std::int64_t> to_int(const Node& node, Range range) {
  if (!node.is_scalar()) return wrong_type(node, "a whole number");
  const std::string& text = node.scalar();
  std::int64_t value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size()) {
    return wrong_type(node, "a whole number");
  }
  if (static_cast<double>(value) < range.min || static_cast<double>(value) > range.max) {
    return fail(ErrorCode::kOutOfRange, text + " is out of range", allowed(range), node.where());
  }
  return value;
}

Result<bool> to_bool(const Node& node) {
  if (node.is_scalar() && node.scalar() == "true") return true;
  if (node.is_scalar() && node.scalar() == "false") return false;
  return wrong_type(node, "true or false");
}

Result<std::string> to_text(const Node& node) {
  if (!node.is_scalar()) return wrong_type(node, "a text");
  return node.scalar();
}

tl::unexpected<Error> unknown_key(const Node& map, const std::string& key,
                                  const std::vector<std::string>& known) {
  const auto child = map.child(key);
  return fail(ErrorCode::kUnknownKey, "unknown key", suggestion(key, known),
              child ? child->where() : map.where());
}

tl::unexpected<Error> missing_key(const Node& map, std::string_view key, std::string_view doc) {
  Location where = map.where();
  where.key += (where.key.empty() ? "" : ".") + std::string(key);
  return fail(ErrorCode::kMissingKey, "required key is missing", std::string(doc), where);
}

tl::unexpected<Error> repeated_key(const Node& map, const std::string& key) {
  const auto child = map.child(key);
  return fail(ErrorCode::kSyntax, "the key stands here twice", "keep one of the two",
              child ? child->where() : map.where());
}

tl::unexpected<Error> not_a_map(const Node& node) { return wrong_type(node, "a map of keys"); }
tl::unexpected<Error> not_a_sequence(const Node& node) { return wrong_type(node, "a list"); }

tl::unexpected<Error> unknown_name(const Node& node, const std::vector<std::string_view>& names) {
  return fail(ErrorCode::kUnknownName,
              (node.is_scalar() ? shown(node.scalar()) : std::string("this")) + " is not known",
              "allowed: " + join(names), node.where());
}

}  // namespace internal

std::string Writer::quoted(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

void Writer::nest(const std::string& block, std::string_view first, std::string_view rest) {
  std::istringstream lines(block);
  bool is_first = true;
  for (std::string one; std::getline(lines, one); is_first = false) {
    text_ += std::string(is_first ? first : rest) + one + "\n";
  }
}

}  // namespace headland::config
