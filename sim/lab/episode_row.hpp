// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace headland {

// A struct of doubles as a row of an episode and back: its `visit(v)` names each member once, in
// order, as v("gap_m", gap_m).

template <class T>
std::vector<std::string> row_columns() {
  std::vector<std::string> names;
  const auto visitor = [&](std::string_view name, double&) { names.emplace_back(name); };
  T value;
  value.visit(visitor);
  return names;
}

template <class T>
std::vector<double> to_row(T value) {
  std::vector<double> row;
  const auto visitor = [&](std::string_view, double& x) { row.push_back(x); };
  value.visit(visitor);
  return row;
}

/// Requires a row of that struct.
template <class T>
T from_row(const std::vector<double>& row) {
  T value;
  std::size_t i = 0;
  const auto visitor = [&](std::string_view, double& x) {
    HEADLAND_CHECK(i < row.size(), "a value for each column");
    x = row[i++];
  };
  value.visit(visitor);
  return value;
}

}  // namespace headland
