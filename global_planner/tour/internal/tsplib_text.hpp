// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "global_planner/tour/internal/instance_text.hpp"

namespace headland::tour {

/// A file of the TSPLIB family (Reinelt 1991): `KEY: value` lines, then sections of words, in any
/// order and free in their line breaks.
class TsplibText {
 public:
  explicit TsplibText(InstanceText& text);

  bool has(const std::string& key) const { return header_.count(key) > 0; }
  /// The first word of a header's value, in capitals; an error if the key is missing.
  std::string word(const std::string& key);
  double number(const std::string& key, double least);
  int whole(const std::string& key, int least, int most);
  /// A section's words, of which there must be `count` (-1: any number).
  const std::vector<Word>& section(const std::string& name, int count);
  int line_of(const std::string& key) const;  ///< of a header or section; the last line if missing

  /// Points of a section of lines `id x y`, ids 1 to count in any order.
  std::vector<Point> coordinates(int count);
  /// Values of a section of lines `id value`, ids 1 to count in any order; each at least 0.
  std::vector<double> values(const std::string& section_name, int count);
  /// Lengths between nodes 0 to count - 1 as EDGE_WEIGHT_TYPE says.
  std::function<double(int, int)> lengths(int count);

 private:
  Word value(const std::string& key);
  std::function<double(int, int)> explicit_lengths(int count);

  InstanceText& text_;
  std::map<std::string, Word> header_;
  std::map<std::string, std::vector<Word>> sections_;
  std::map<std::string, int> section_line_;
};

}  // namespace headland::tour
