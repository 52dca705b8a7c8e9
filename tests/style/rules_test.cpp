// SPDX-License-Identifier: Apache-2.0
// Each rule must be able to fail: here it gets what it is there to find.
#include "tests/style/rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace headland::style {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SourceFile including(std::string path, const std::string& header) {
  return {std::move(path), "#include " + header + "\n"};
}

TEST(Layering, EdgesThatDesignForbidsAreFound) {
  const std::vector<std::pair<std::string, std::string>> forbidden = {
      {"core/a.cpp", "\"control/tracker.hpp\""},
      {"control/a.cpp", "\"global_planner/tour/x.hpp\""},
      {"global_planner/a.hpp", "\"sim/x.hpp\""},
      {"local_planner/a.cpp", "\"perception/x.hpp\""},
      {"sim/a.cpp", "\"control/tracker.hpp\""},
      {"sim/a.cpp", "\"sim/lab/x.hpp\""},
      {"sim/lab/a.cpp", "\"apps/report.hpp\""},
      {"fleet/coordinator/a.cpp", "\"control/tracker.hpp\""},
      {"fleet/store/a.cpp", "\"sim/x.hpp\""},
      {"fleet/vehicle/a.cpp", "\"sim/lab/x.hpp\""},
      {"control/a.cpp", "\"core/geometry/internal/steering.hpp\""},
  };
  for (const auto& [path, header] : forbidden) {
    EXPECT_EQ(check_layering(including(path, header)).size(), 1U) << path << " " << header;
  }
}

TEST(Layering, EdgesThatDesignAllowsPass) {
  const std::vector<std::pair<std::string, std::string>> allowed = {
      {"core/geometry/a.cpp", "\"core/geometry/internal/steering.hpp\""},
      {"control/pure_pursuit/a.hpp", "\"control/tracker.hpp\""},
      {"sim/lab/a.cpp", "\"control/tracker.hpp\""},
      {"sim/lab/a.cpp", "\"sim/x.hpp\""},
      {"fleet/vehicle/a.cpp", "\"local_planner/x.hpp\""},
      {"apps/a.cpp", "\"sim/lab/x.hpp\""},
      {"core/a.hpp", "<vector>"},
      {"core/a.hpp", "<Eigen/Core>"},
      {"tests/core/a_test.cpp", "\"control/tracker.hpp\""},
  };
  for (const auto& [path, header] : allowed) {
    EXPECT_THAT(check_layering(including(path, header)), IsEmpty()) << path << " " << header;
  }
}

TEST(Layering, LibrariesStayInTheirFolderAndOutOfPublicHeaders) {
  const std::vector<std::pair<std::string, std::string>> forbidden = {
      {"control/a.cpp", "<yaml-cpp/yaml.h>"},
      {"core/config/a.hpp", "<yaml-cpp/yaml.h>"},
      {"sim/a.cpp", "<nlohmann/json.hpp>"},
      {"apps/report.hpp", "<nlohmann/json.hpp>"},
      {"global_planner/tour/a.cpp", "<ompl/base/StateSpace.h>"},
      {"control/pure_pursuit/a.cpp", "<coin/IpTNLP.hpp>"},
      {"local_planner/a.cpp", "<pcl/point_types.h>"},
      {"core/a.cpp", "<CLI/CLI.hpp>"},
      {"core/a.cpp", "<some_library/header.h>"},
  };
  for (const auto& [path, header] : forbidden) {
    EXPECT_EQ(check_layering(including(path, header)).size(), 1U) << path << " " << header;
  }
  EXPECT_THAT(check_layering(including("core/a.cpp", "<yaml-cpp/yaml.h>")), IsEmpty());
  EXPECT_THAT(check_layering(including("core/x/internal/a.hpp", "<nlohmann/json.hpp>")), IsEmpty());
  EXPECT_THAT(check_layering(including("sim/lab/a.cpp", "<nlohmann/json.hpp>")), IsEmpty());
}

TEST(Layering, ComplaintsNameTheLine) {
  EXPECT_THAT(check_layering({"core/a.cpp", "\n\n#include \"sim/x.hpp\"\n"}),
              ElementsAre("core/a.cpp:3: core must not include \"sim/x.hpp\""));
}

std::string function_of(int lines, const std::string& head) {
  std::string text = head + " {\n";
  for (int i = 2; i < lines; ++i) text += "  work(\"}}\");  // {\n";
  return text + "}\n";
}

TEST(Size, LongFunctionsAreFoundAndTheLastAllowedIsNot) {
  EXPECT_THAT(check_size({"core/a.cpp", function_of(80, "int f(int x)")}), IsEmpty());
  EXPECT_THAT(check_size({"core/a.cpp", "\n" + function_of(81, "int f(int x)")}),
              ElementsAre(HasSubstr("core/a.cpp:2: a function of 81 lines")));
  EXPECT_EQ(check_size({"core/a.hpp", "struct S {\n" + function_of(81, "int f()") + "};\n"}).size(),
            1U);
  EXPECT_EQ(check_size({"console/src/a.ts", function_of(81, "export function f(): void")}).size(),
            1U);
}

TEST(Size, LongStructsAndNamespacesAreNotFunctions) {
  EXPECT_THAT(check_size({"core/a.cpp", function_of(90, "namespace a")}), IsEmpty());
  EXPECT_THAT(check_size({"core/a.cpp", function_of(90, "struct A")}), IsEmpty());
}

TEST(Size, LongFilesAreFound) {
  EXPECT_EQ(check_size({"core/a.cpp", std::string(601, '\n')}).size(), 1U);
  EXPECT_THAT(check_size({"core/a.cpp", std::string(600, '\n')}), IsEmpty());
  EXPECT_THAT(check_size({"docs/a.md", std::string(900, '\n')}), IsEmpty());
}

TEST(Licence, MissingLineIsFound) {
  const std::string line = "SPDX-License-Identifier: Apache-2.0\n";
  for (const char* path :
       {"core/a.cpp", "core/a.hpp", "console/a.ts", "a.sh", "CMakeLists.txt", "cmake/A.cmake"}) {
    EXPECT_EQ(check_licence({path, "int x;\n"}).size(), 1U) << path;
    EXPECT_THAT(check_licence({path, "// " + line}), IsEmpty()) << path;
  }
  EXPECT_THAT(check_licence({"a.sh", "#!/bin/sh\n# " + line}), IsEmpty());
  EXPECT_EQ(check_licence({"core/a.cpp", "int x;\n\n\n// " + line}).size(), 1U);
}

TEST(Units, KeysOfDoublesWithoutUnitAreFound) {
  const auto with_key = [](const std::string& key) {
    return SourceFile{"core/a.hpp",
                      "struct A {\n  double x = 0.0;\n  int n = 0;\n  void visit(V& v)"
                      " {\n    v(\"" +
                          key + "\", x);\n    v(\"n\", n);\n  }\n};\n"};
  };
  EXPECT_THAT(check_units(with_key("lookahead")), ElementsAre(HasSubstr("core/a.hpp:5")));
  EXPECT_EQ(check_units(with_key("speed_kph")).size(), 1U);
  for (const char* key : {"lookahead_m", "speed_mps", "work_j", "start_soc", "soc",
                          "overlap_ratio", "curvature_1pm", "angle_deg"}) {
    EXPECT_THAT(check_units(with_key(key)), IsEmpty()) << key;
  }
}

TEST(Units, RequiredKeysAndWrappedCallsCountToo) {
  EXPECT_EQ(check_units({"a.hpp", "  double x;\n  v.required(\n      \"speed\", x);\n"}).size(),
            1U);
  EXPECT_EQ(check_units({"a.hpp", "  std::optional<double> x;\n  v(\"speed\", x);\n"}).size(), 1U);
}

TEST(Flags, ProcessorFlagsAreFoundInBuildFilesOnly) {
  const std::string native = "add_compile_options(-march=native)\n";
  EXPECT_EQ(check_flags({"CMakeLists.txt", native}).size(), 1U);
  EXPECT_EQ(check_flags({"cmake/A.cmake", "set(F -mavx2)\n"}).size(), 1U);
  EXPECT_EQ(check_flags({"CMakePresets.json", "\"-ffast-math\"\n"}).size(), 1U);
  EXPECT_THAT(check_flags({"CMakeLists.txt", "# never -march=native\n"}), IsEmpty());
  EXPECT_THAT(check_flags({"docs/a.md", native}), IsEmpty());
}

TEST(MachinePaths, PathsOfAMachineAreFoundAndUrlsAreNot) {
  const std::string slash = "/";
  EXPECT_EQ(check_machine_paths({"docs/a.md", "see " + slash + "work/x\n"}).size(), 1U);
  EXPECT_EQ(check_machine_paths({"docs/a.md", "cd " + slash + "root/x\n"}).size(), 1U);
  EXPECT_EQ(check_machine_paths({"a.cpp", "\"" + slash + "home/ann/x\"\n"}).size(), 1U);
  EXPECT_THAT(check_machine_paths({"docs/a.md", "https://a.org/work/x ./work/x\n"}), IsEmpty());
}

TEST(Readmes, FoldersWithoutOneAreFound) {
  EXPECT_THAT(check_readmes({{"core/README.md", ""}, {"core/base/a.cpp", ""}}),
              ElementsAre("core/base:1: no README.md"));
  EXPECT_THAT(check_readmes({{"apps/main.cpp", ""}}), ElementsAre("apps:1: no README.md"));
  EXPECT_THAT(check_readmes({{"core/README.md", ""},
                             {"core/base/README.md", ""},
                             {"core/base/internal/a.hpp", ""},
                             {"docs/a.md", ""}}),
              IsEmpty());
}

TEST(Papers, RowsThatNameMissingFilesAreFound) {
  const std::vector<SourceFile> tree = {{"core/geometry/dubins.cpp", ""}};
  EXPECT_THAT(check_papers({"docs/papers.md", "| (002) | `core/geometry/dubins.cpp` |\n"}, tree),
              IsEmpty());
  EXPECT_THAT(
      check_papers({"docs/papers.md", "| a |\n| (002) | `core/geometry/gone.cpp:12` |\n"}, tree),
      ElementsAre("docs/papers.md:2: there is no core/geometry/gone.cpp"));
}

TEST(WithoutLiterals, BlanksCommentsAndStringsAndKeepsLines) {
  EXPECT_EQ(without_literals("a \"}\\\"{\" b // {\nc"), "a        b     \nc");
  EXPECT_EQ(without_literals("/* {\n} */ x"), "    \n     x");
  EXPECT_EQ(without_literals("R\"(}\")\" x"), "        x");
  EXPECT_EQ(without_literals("1'000 {'{'}"), "1'000 {   }");
}

}  // namespace
}  // namespace headland::style
