// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace headland::testing {

/// How often this program has asked for heap memory through operator new. Linking this in replaces
/// operator new; a control tick must leave the number as it is.
long allocation_count();

}  // namespace headland::testing
