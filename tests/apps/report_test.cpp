// SPDX-License-Identifier: Apache-2.0
#include "apps/report.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/sample_report.hpp"

namespace headland {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("headland_report_" + name);
  std::filesystem::remove_all(folder);
  return folder;
}

// The JSON that stands in a page, as a browser would hand it to the script.
nlohmann::json data_of(const std::string& html) {
  const std::string begin = "<script id=\"data\" type=\"application/json\">";
  const std::size_t from = html.find(begin) + begin.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script", from) - from));
}

TEST(Report, PageHoldsTheSameDataAsTheJsonFile) {
  const auto folder = fresh_folder("sample");
  const auto written = write_report(sample_report(12, 10000), folder);
  ASSERT_TRUE(written) << to_string(written.error());
  const auto data = data_of(text_of(folder / "report.html"));
  EXPECT_EQ(data, nlohmann::json::parse(text_of(folder / "report.json")));
  EXPECT_EQ(data["kind"], "run");
  const auto& series = data["vehicles"][0]["series"];
  EXPECT_EQ(series["s_m"].size(), series["leg"].size());
  EXPECT_EQ(data["tables"][0]["columns"].size(), data["tables"][0]["rows"][0].size());
}

TEST(Report, NothingIsLeftBesideTheFiles) {
  const auto folder = fresh_folder("atomic");
  ASSERT_TRUE(write_report(Report{}, folder));
  ASSERT_TRUE(write_report(Report{}, folder)) << "a second time, over the first";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files += entry.path().extension() == ".part" ? 100 : 1;
  }
  EXPECT_EQ(files, 2);
}

TEST(Report, SameReportGivesTheSameBytes) {
  EXPECT_EQ(*report_json(sample_report(5, 500)), *report_json(sample_report(5, 500)));
}

TEST(Report, TextsCannotLeaveTheirElement) {
  Report report;
  report.title = "</title><script>alert(1)</script>";
  report.config_yaml = "a: </script><!-- <script>";
  const auto json = report_json(report);
  ASSERT_TRUE(json);
  const std::string html = report_html(report.title, *json);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("</title><"), std::string::npos);
  EXPECT_EQ(data_of(html)["config_yaml"], report.config_yaml);
  EXPECT_EQ(data_of(html)["title"], report.title);
}

TEST(Report, TextsThatAreNotUtf8AreMendedNotThrown) {
  Report report;
  report.title = "caf\xe9";
  const auto json = report_json(report);
  ASSERT_TRUE(json);
  EXPECT_EQ(nlohmann::json::parse(*json)["title"], "caf\xef\xbf\xbd");
}

TEST(Report, PageAsksTheNetworkForNothing) {
  const std::string html = report_html("t", "{}");
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* word : {" src=", "@import", "url(", "fetch(", "XMLHttpRequest", "import("}) {
    EXPECT_EQ(html.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(html.find("@TITLE@"), std::string::npos);
  EXPECT_EQ(html.find("@DATA@"), std::string::npos);
}

TEST(Report, PageCarriesTheLicenceOfD3) {
  EXPECT_NE(report_html("t", "{}").find("Mike Bostock"), std::string::npos);
}

TEST(Report, LengthsAreRoundedToMillimetresAndMissingNumbersAreNull) {
  Report report;
  ReportSeries series;
  series.s_m = {0.0, 1.23456};
  series.x_m = {-0.0001, 2.0};
  series.error_m = {std::numeric_limits<double>::quiet_NaN(), 0.01234567};
  report.vehicles = {{"t1", 0.123456, series, {{1.00049, 0.2, 0.9, "charger"}}}};
  report.tiles = {{"a", std::numeric_limits<double>::infinity()}, {"b", 1234567.89}, {"c", 42.0}};
  const auto json = nlohmann::json::parse(*report_json(report));
  const auto& vehicle = json["vehicles"][0];
  EXPECT_EQ(vehicle["series"]["s_m"][1], 1.235);
  EXPECT_EQ(vehicle["series"]["x_m"].dump(), "[0,2.0]");
  EXPECT_TRUE(vehicle["series"]["error_m"][0].is_null());
  EXPECT_EQ(vehicle["series"]["error_m"][1], 0.0123);
  EXPECT_TRUE(vehicle["series"]["soc"].empty());
  EXPECT_EQ(vehicle["reserve_soc"], 0.12346);
  EXPECT_EQ(vehicle["stops"][0]["s_m"], 1.0);
  EXPECT_TRUE(json["tiles"][0]["value"].is_null());
  EXPECT_EQ(json["tiles"][1]["value"], 1234570.0);
  EXPECT_EQ(json["tiles"][2]["value"].dump(), "42");
}

TEST(Report, ColumnsOfDifferentLengthAreAnError) {
  Report report;
  report.vehicles.resize(2);
  report.vehicles[1].series.s_m = {0.0, 1.0};
  report.vehicles[1].series.x_m = {0.0};
  const auto json = report_json(report);
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().code, ErrorCode::kInternal);
}

TEST(Report, HeightsThatDoNotFillTheirGridAreAnError) {
  Report report;
  report.terrain = ReportTerrain{{0.0, 0.0}, 1.0, 3, 2, {1.0, 2.0, 3.0}};
  ASSERT_FALSE(report_json(report));
}

TEST(Report, VehiclesReasonsAndTerrainAreWritten) {
  const Report report = sample_fleet_report();
  const auto json = nlohmann::json::parse(*report_json(report));
  EXPECT_EQ(json["vehicles"].size(), 3U);
  EXPECT_EQ(json["vehicles"][2]["name"], "t3");
  EXPECT_FALSE(json["vehicles"][0]["stops"].empty());
  EXPECT_EQ(json["why"].back().count("leg"), 0U) << "of no leg";
  EXPECT_EQ(json["why"][0]["vehicle"], 0);
  EXPECT_EQ(json["terrain"]["columns"], report.terrain->columns);
  const std::size_t bytes = 2 * report.terrain->heights_m.size();
  EXPECT_EQ(json["terrain"]["heights"].get<std::string>().size(), (bytes + 2) / 3 * 4);
  EXPECT_NEAR(json["terrain"]["high_m"].get<double>(), 24.0, 1.0);
  int of_third = 0;
  for (const auto& feature : json["map"]["features"]) of_third += feature.value("vehicle", -1) == 2;
  EXPECT_GT(of_third, 10);
}

TEST(Report, ManyVehiclesShareThePointsThatAPageMayHave) {
  Report report = sample_report(40, 100000);
  report.vehicles.resize(8, report.vehicles.front());
  const auto json = nlohmann::json::parse(*report_json(report));
  std::size_t points = 0;
  for (const auto& vehicle : json["vehicles"]) points += vehicle["series"]["s_m"].size();
  EXPECT_LE(points, static_cast<std::size_t>(kMaxReportPoints));
  EXPECT_GE(points, static_cast<std::size_t>(kMaxReportPoints / 2));
}

TEST(Report, UnwritableFolderIsAnErrorThatNamesIt) {
  const auto written = write_report(Report{}, "/proc/no_such_folder");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kFileNotWritable);
  EXPECT_NE(written.error().where.file.find("no_such_folder"), std::string::npos);
}

TEST(ThinOut, KeepsEndsOrderAndEveryStretchesLargestValue) {
  std::vector<double> values(200000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(0.001 * double(i));
  values[123457] = -9.0;
  const auto kept = thin_out(static_cast<int>(values.size()), values, kMaxReportPoints);
  EXPECT_LE(kept.size(), static_cast<std::size_t>(kMaxReportPoints));
  EXPECT_GE(kept.size(), static_cast<std::size_t>(kMaxReportPoints / 2));
  EXPECT_EQ(kept.front(), 0);
  EXPECT_EQ(kept.back(), 199999);
  EXPECT_NE(std::find(kept.begin(), kept.end(), 123457), kept.end());
  for (std::size_t i = 1; i < kept.size(); ++i) ASSERT_LT(kept[i - 1], kept[i]);
}

TEST(ThinOut, ShortSeriesStayWhole) {
  EXPECT_EQ(thin_out(3, {}, 4), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(thin_out(0, {}, 4).empty());
  EXPECT_LE(thin_out(100, {}, 4).size(), 4U);
}

TEST(Report, LongRunGivesASmallPage) {
  const auto folder = fresh_folder("long");
  ASSERT_TRUE(write_report(sample_report(40, 200000), folder));
  EXPECT_LT(std::filesystem::file_size(folder / "report.html"), 3U << 20U);
}

}  // namespace
}  // namespace headland
