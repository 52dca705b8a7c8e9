// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/output_files.hpp"
#include "apps/plan_output.hpp"
#include "apps/planned_mission.hpp"
#include "apps/report_content.hpp"

namespace headland::apps {

int plan_command(const CommonOptions& options) {
  if (auto ready = prepare_output(options.out); !ready) {
    return report_error(ready.error(), options);
  }
  const auto planned = plan_from_file(options);
  if (!planned) return report_error(planned.error(), options);
  const std::string summary = summary_json(planned->plan, planned->planning_s, planned->stamp);
  const auto written = write_report(
      plan_report(*planned), options.out,
      {{"summary.json", summary},
       {"plan.geojson", plan_geojson(planned->plan, planned->mission.farm, planned->stamp)}});
  if (!written) return report_error(written.error(), options);
  if (options.json) {
    fmt::print("{}", summary);
  } else {
    fmt::print("{}{}", plan_text(planned->plan, planned->planning_s), report_line(options.out));
  }
  return 0;
}

}  // namespace headland::apps
