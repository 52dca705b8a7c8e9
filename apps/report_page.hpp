// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace headland {

/// The page of console/, built in by its CMakeLists.txt, cut where the title and the data go.
struct ReportPage {
  std::string_view before_title;
  std::string_view before_data;
  std::string_view after_data;
};

const ReportPage& report_page();

}  // namespace headland
