// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace headland::config {

/// Inclusive bounds of a number. The default allows any finite value.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};
/// Strictly greater than zero.
inline constexpr Range kPositive{std::numeric_limits<double>::min(),
                                 std::numeric_limits<double>::infinity()};
/// Zero or more.
inline constexpr Range kNonNegative{0.0, std::numeric_limits<double>::infinity()};
/// A fraction.
inline constexpr Range kFraction{0.0, 1.0};

/// Names of an enum's values, for files: specialise it beside the enum.
///   template <> struct EnumNames<Gear> { static constexpr std::pair<Gear, std::string_view>
///     values[] = {{Gear::kForward, "forward"}, ...}; };
template <class E>
struct EnumNames;

template <class E>
std::string_view enum_name(E value) {
  for (const auto& [candidate, name] : EnumNames<E>::values) {
    if (candidate == value) return name;
  }
  return "?";
}

// A configuration struct lists its members once:
//
//   struct BatteryConfig {
//     double capacity_wh = 0.0;
//     double reserve_soc = 0.2;
//     template <class V> void visit(V& v) {
//       v.required("capacity_wh", capacity_wh, kPositive, "Usable energy when full [Wh]");
//       v("reserve_soc", reserve_soc, kFraction, "State of charge the plan never goes below");
//     }
//   };
//
// and that one list reads it, writes it, checks its ranges and documents it. A member may be a
// double, int, bool, string, enum (EnumNames), another such struct, std::optional or std::vector of
// these. After reading, `std::optional<Error> check() const`, where the struct has one, sees the
// whole.

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

}  // namespace headland::config
