// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "core/base/error.hpp"

namespace headland {

/// A value, or the Error that explains why there is none. For outcomes a caller must expect.
template <class T>
using Result = tl::expected<T, Error>;

/// `return fail(ErrorCode::kNoPath, "what", "remedy");`
inline tl::unexpected<Error> fail(ErrorCode code, std::string what, std::string remedy = {},
                                  Location where = {}) {
  return tl::unexpected<Error>(Error{code, std::move(what), std::move(remedy), std::move(where)});
}

}  // namespace headland
