// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "global_planner/tour/instance_io.hpp"

namespace headland::tour {

/// More nodes than this are refused: the ways between 4000 take half a gigabyte.
inline constexpr int kMaxNodes = 4000;

/// A word of an instance file, and where it stands.
struct Word {
  std::string_view text;
  int line = 0;  ///< 1-based
};

/// An instance file as words in lines; lines without words are left out. Readers take numbers from
/// it and go on after a wrong one: the first error is kept, as a stream keeps its failure.
class InstanceText {
 public:
  InstanceText(std::string file, const std::string& text);
  InstanceText(const InstanceText&) = delete;  // words point into it
  InstanceText& operator=(const InstanceText&) = delete;

  const std::vector<std::vector<Word>>& lines() const { return lines_; }
  std::string_view line_text(int line) const;  ///< trimmed
  int last_line() const { return static_cast<int>(raw_.size()); }
  std::string stem() const;  ///< the file's name without folder and ending

  /// A finite number of at least `least`; 0 and an error if the word is none.
  double number(const Word& word, std::string_view what, double least);
  /// A whole number within bounds; `least` and an error if the word is none.
  int whole(const Word& word, std::string_view what, int least, int most);

  void wrong(ErrorCode code, int line, std::string what, std::string remedy);
  bool ok() const { return !error_; }
  const std::optional<Error>& error() const { return error_; }

 private:
  std::string file_;
  std::string text_;
  std::vector<std::string_view> raw_;
  std::vector<std::vector<Word>> lines_;
  std::optional<Error> error_;
};

struct Point {
  double x = 0.0;
  double y = 0.0;
};
double euclidean(const Point& a, const Point& b);

/// Sets all ways of one profile by length: cost, duration and energy per unit of it.
void set_ways(TourProblem& problem, const std::function<double(int, int)>& length,
              double cost_per_unit, double duration_per_unit, double energy_per_unit);

/// Adds a task at one place. Its work takes `service_s` and nothing else.
TourTask& add_place(RouteInstance& instance, int site, std::string name, double service_s);

RouteInstance read_tsplib(InstanceText& text);
RouteInstance read_schneider(InstanceText& text);
RouteInstance read_orienteering(InstanceText& text);
/// Makes tasks, budget and rewards of an orienteering problem: site 0 is the start, `finish` a
/// site.
void set_orienteering(RouteInstance& instance, const std::function<double(int, int)>& length,
                      const std::vector<double>& scores, int finish, double budget, int paths);

}  // namespace headland::tour
