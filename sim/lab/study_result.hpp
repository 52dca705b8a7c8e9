// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace headland {

/// What is known of one metric of one cell. A metric that is a plain number has only its mean.
/// The unit is the suffix of the metric's name.
struct Statistic {
  double mean = 0.0;
  std::optional<double> median{};
  std::optional<double> std{};  ///< standard deviation
  std::optional<double> p95{};
  std::optional<double> p99{};     ///< of metrics with very many values only
  std::optional<double> ci_low{};  ///< 95 % confidence interval of the mean (or of a proportion)
  std::optional<double> ci_high{};
};

/// One cell of a study's grid.
struct StudyCell {
  std::string name;  ///< the cell's key, such as track/ours/D
  int n = 1;         ///< runs behind it
  std::vector<std::pair<std::string, Statistic>> metrics{};  ///< in the order they are shown

  void add(std::string metric, double value) {
    metrics.emplace_back(std::move(metric), Statistic{value});
  }
  /// The metric of that name, or null.
  const Statistic* find(const std::string& metric) const {
    for (const auto& [name_of, value] : metrics) {
      if (name_of == metric) return &value;
    }
    return nullptr;
  }
};

struct PlotSeries {
  std::string name;
  std::vector<double> x{};
  std::vector<double> y{};
};

struct Plot {
  std::string title;
  std::string x_label;  ///< with its unit
  std::string y_label;
  std::vector<PlotSeries> series{};
};

/// A table for readers, already formatted.
struct StudyTable {
  std::string title;
  std::vector<std::string> header{};
  std::vector<std::vector<std::string>> rows{};
};

/// What a study found: the same struct for all studies, written by one writer.
struct StudyResult {
  std::string study;  ///< ebs221, polito, ...
  std::vector<StudyCell> cells{};
  std::vector<Plot> plots{};
  std::vector<StudyTable> tables{};
  std::vector<std::string> files{};  ///< names of what it wrote into the output folder itself

  /// The cell of that name, or null.
  const StudyCell* find(const std::string& cell) const {
    for (const StudyCell& candidate : cells) {
      if (candidate.name == cell) return &candidate;
    }
    return nullptr;
  }
};

}  // namespace headland
