// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/world/camera.hpp"

namespace headland {

/// The class of a name as COCO, Pascal VOC and others have them. All farm animals are livestock, as
/// are those that small networks take them for; what is not known is kOther.
ObjectClass class_of_name(std::string_view name);

/// A network's classes, in its order, from a text with one name a line. Lines of white space alone
/// at the end are left out; capitals do not matter.
/// @return kSyntax if no name is of a person, livestock or a vehicle: it is not a list of names.
Result<std::vector<ObjectClass>> parse_class_names(std::string_view text);

}  // namespace headland
