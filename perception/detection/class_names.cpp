// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/class_names.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace headland {
namespace {

struct NamedClass {
  std::string_view name;
  ObjectClass object;
};

constexpr NamedClass kNames[] = {
    {"person", ObjectClass::kPerson},       {"pedestrian", ObjectClass::kPerson},
    {"people", ObjectClass::kPerson},       {"horse", ObjectClass::kLivestock},
    {"cow", ObjectClass::kLivestock},       {"cattle", ObjectClass::kLivestock},
    {"sheep", ObjectClass::kLivestock},     {"goat", ObjectClass::kLivestock},
    {"pig", ObjectClass::kLivestock},       {"dog", ObjectClass::kLivestock},
    {"cat", ObjectClass::kLivestock},       {"elephant", ObjectClass::kLivestock},
    {"bear", ObjectClass::kLivestock},      {"zebra", ObjectClass::kLivestock},
    {"giraffe", ObjectClass::kLivestock},   {"deer", ObjectClass::kLivestock},
    {"livestock", ObjectClass::kLivestock}, {"bicycle", ObjectClass::kVehicle},
    {"car", ObjectClass::kVehicle},         {"van", ObjectClass::kVehicle},
    {"motorbike", ObjectClass::kVehicle},   {"motorcycle", ObjectClass::kVehicle},
    {"bus", ObjectClass::kVehicle},         {"train", ObjectClass::kVehicle},
    {"truck", ObjectClass::kVehicle},       {"tractor", ObjectClass::kVehicle},
    {"vehicle", ObjectClass::kVehicle},
};

std::string_view trimmed(std::string_view line) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t begin = line.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kSpace) - begin + 1);
}

}  // namespace

ObjectClass class_of_name(std::string_view name) {
  std::string lower(trimmed(name));
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  for (const NamedClass& known : kNames) {
    if (known.name == lower) return known.object;
  }
  return ObjectClass::kOther;
}

Result<std::vector<ObjectClass>> parse_class_names(std::string_view text) {
  std::vector<ObjectClass> classes;
  std::size_t named = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    classes.push_back(class_of_name(line));
    if (!line.empty()) named = classes.size();
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  classes.resize(named);
  const bool is_any = std::any_of(classes.begin(), classes.end(),
                                  [](ObjectClass object) { return object != ObjectClass::kOther; });
  if (!is_any) {
    return fail(ErrorCode::kSyntax, "no person, animal or vehicle among the names of classes",
                "one name a line, in the network's order, such as coco.names");
  }
  return classes;
}

}  // namespace headland
