// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/episode_log.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr std::string_view kMark = "# headland episodes: ";
constexpr std::string_view kKeyColumns = "cell,run,row,rows_count";

template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// What stands before the first `mark`, which is taken off `rest` with it; all if there is none.
std::string_view cut(std::string_view& rest, char mark) {
  const std::size_t at = rest.find(mark);
  const std::string_view part = rest.substr(0, at);
  rest.remove_prefix(at == std::string_view::npos ? rest.size() : at + 1);
  return part;
}

struct Line {
  EpisodeKey key;
  int row = 0;
  int rows_count = 0;
  std::vector<double> values;
};

std::optional<Line> parse(std::string_view text, const std::map<std::string, int, std::less<>>& ids,
                          std::size_t columns) {
  const auto cell = ids.find(cut(text, ','));
  const auto run = number<int>(cut(text, ','));
  const auto row = number<int>(cut(text, ','));
  const auto rows = number<int>(cut(text, ','));
  if (cell == ids.end() || !run || *run < 0 || !row || !rows) return std::nullopt;
  Line line{{cell->second, *run}, *row, *rows, {}};
  while (!text.empty()) {
    const auto value = number<double>(cut(text, ','));
    if (!value) return std::nullopt;
    line.values.push_back(*value);
  }
  return line.values.size() == columns ? std::optional(std::move(line)) : std::nullopt;
}

tl::unexpected<Error> not_writable(const std::filesystem::path& file, std::string what) {
  return fail(ErrorCode::kFileNotWritable, std::move(what),
              "choose another directory with --out, or delete the file", {file.string(), 0, ""});
}

}  // namespace

EpisodeLog::EpisodeLog(std::filesystem::path file, const std::string& study,
                       std::uint64_t config_hash, std::vector<std::string> columns,
                       std::vector<std::string> cells)
    : file_(std::move(file)),
      title_(fmt::format("{}{}, configuration {:016x}", kMark, study, config_hash)),
      columns_(std::move(columns)),
      cells_(std::move(cells)) {}

Result<std::map<EpisodeKey, EpisodeRows>> EpisodeLog::read() const {
  std::map<EpisodeKey, EpisodeRows> episodes;
  std::ifstream stream(file_, std::ios::binary);
  if (!stream) return episodes;
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::string_view rest = text;
  const std::string_view title = cut(rest, '\n');
  if (!title.starts_with(kMark)) return episodes;
  if (title != title_) {
    return not_writable(
        file_, fmt::format("holds episodes of '{}', not of '{}'", title.substr(kMark.size()),
                           std::string_view(title_).substr(kMark.size())));
  }
  cut(rest, '\n');
  std::map<std::string, int, std::less<>> ids;
  for (std::size_t i = 0; i < cells_.size(); ++i) ids.emplace(cells_[i], static_cast<int>(i));
  std::map<EpisodeKey, int> due;  // how many rows each should have
  while (rest.find('\n') != std::string_view::npos) {
    auto line = parse(cut(rest, '\n'), ids, columns_.size());
    if (!line) continue;
    EpisodeRows& rows = episodes[line->key];
    if (line->row == static_cast<int>(rows.size())) rows.push_back(std::move(line->values));
    due[line->key] = line->rows_count;
  }
  std::erase_if(episodes, [&](const auto& episode) {
    return static_cast<int>(episode.second.size()) != due[episode.first];
  });
  return episodes;
}

Result<void> EpisodeLog::write(const std::map<EpisodeKey, EpisodeRows>& episodes) const {
  const std::filesystem::path part = file_.string() + ".part";
  std::ofstream stream(part, std::ios::binary);
  stream << title_ << '\n' << kKeyColumns;
  for (const std::string& column : columns_) stream << ',' << column;
  stream << '\n';
  for (const auto& [key, rows] : episodes) stream << lines_of(key, rows);
  stream.close();
  std::error_code code;
  if (stream) std::filesystem::rename(part, file_, code);
  if (!stream || code) return not_writable(file_, "cannot be written");
  return {};
}

Result<void> EpisodeLog::append(const EpisodeKey& key, const EpisodeRows& rows) const {
  std::ofstream stream(file_, std::ios::binary | std::ios::app);
  stream << lines_of(key, rows);
  stream.close();
  if (!stream) return not_writable(file_, "cannot be written");
  return {};
}

std::string EpisodeLog::lines_of(const EpisodeKey& key, const EpisodeRows& rows) const {
  HEADLAND_CHECK(!rows.empty(), "an episode without a row cannot be told from an unfinished one");
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    HEADLAND_CHECK(rows[i].size() == columns_.size(), "a value for each column");
    text += fmt::format("{},{},{},{}", cells_[static_cast<std::size_t>(key.cell)], key.run, i,
                        rows.size());
    for (const double value : rows[i]) text += fmt::format(",{}", value);
    text += '\n';
  }
  return text;
}

}  // namespace headland
