// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/recurrent_network.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "local_planner/prediction/response_features.hpp"

namespace headland {
namespace {

using Eigen::Index;

constexpr std::string_view kTitle = "headland response network";
constexpr int kVersion = 1;

// The parts of a network, in the order of the file.
template <class Network, class Visit>
void for_each_layer(Network& network, Visit visit) {
  visit("robot", network.robot);
  visit("neighbor", network.neighbor);
  visit("encoder", network.encoder.gates);
  visit("decoder", network.decoder.gates);
  visit("head", network.head);
}

// Takes the words of a text one after the other and keeps the first error.
class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  const std::optional<Error>& error() const { return error_; }
  void wrong(ErrorCode code, std::string what, std::string remedy = "train the network again") {
    if (error_) return;
    const auto line = std::count(text_.begin(), std::next(text_.begin(), at_), '\n') + 1;
    error_ = Error{code, std::move(what), std::move(remedy), {name_, static_cast<int>(line), {}}};
  }
  std::string_view word() {
    const auto begin = text_.find_first_not_of(" \n", static_cast<std::size_t>(at_));
    if (begin == std::string_view::npos) {
      at_ = static_cast<std::ptrdiff_t>(text_.size());
      wrong(ErrorCode::kSyntax, "the file is cut short");
      return {};
    }
    const auto end = std::min(text_.find_first_of(" \n", begin), text_.size());
    at_ = static_cast<std::ptrdiff_t>(end);
    return text_.substr(begin, end - begin);
  }
  void expect(std::string_view wanted) {
    const std::string_view found = word();
    if (found != wanted) {
      wrong(ErrorCode::kSyntax, fmt::format("\"{}\" where \"{}\" is due", found, wanted));
    }
  }
  template <class Number>
  Number number() {
    const std::string_view found = word();
    Number value{};
    const auto [end, code] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (code != std::errc() || end != found.data() + found.size()) {
      wrong(ErrorCode::kSyntax, fmt::format("\"{}\" where a number is due", found));
    } else if (!std::isfinite(static_cast<double>(value))) {
      wrong(ErrorCode::kOutOfRange, fmt::format("a weight is {}", found));
    }
    return value;
  }

 private:
  std::string_view text_;
  std::string name_;
  std::ptrdiff_t at_ = 0;
  std::optional<Error> error_;
};

void read_layer(Reader& reader, std::string_view layer_name, LinearLayer& layer) {
  constexpr int kMost = 4096;
  reader.expect("layer");
  reader.expect(layer_name);
  const int rows = reader.number<int>();
  const int columns = reader.number<int>();
  if (rows < 1 || columns < 1 || rows > kMost || columns > kMost) {
    reader.wrong(ErrorCode::kOutOfRange, fmt::format("a layer of {} x {}", rows, columns));
  }
  if (reader.error()) return;
  layer.weight.resize(rows, columns);
  layer.bias.resize(rows);
  for (int i = 0; i < rows && !reader.error(); ++i) {
    for (int j = 0; j < columns; ++j) layer.weight(i, j) = reader.number<float>();
    layer.bias(i) = reader.number<float>();
  }
}

// What does not fit in a network whose numbers are all right; empty if all does.
std::string misfit(const ResponseNetwork& network) {
  const Index inputs = kOwnFeatures + network.robot.weight.rows() + network.neighbor.weight.rows();
  const auto fits = [inputs](const LstmCell& cell, Index hidden) {
    return cell.gates.weight.rows() == 4 * hidden && cell.gates.weight.cols() == inputs + hidden;
  };
  const Index hidden = network.head.weight.cols();
  if (network.robot.weight.cols() != kPairFeatures) return "robot";
  if (network.neighbor.weight.cols() != kPairFeatures) return "neighbor";
  if (!fits(network.encoder, hidden)) return "encoder";
  if (!fits(network.decoder, hidden)) return "decoder";
  return network.head.weight.rows() == kHeadOutputs ? "" : "head";
}

std::string checksum(std::string_view body) { return fmt::format("{:016x}", fnv1a(body)); }

}  // namespace

void make_room(Eigen::MatrixXf& matrix, Index rows, Index columns) {
  if (matrix.rows() == rows && matrix.cols() >= columns) return;
  Index room = 16;
  while (room < columns) room *= 2;
  matrix.conservativeResize(rows, room);
}

void LstmBatch::reset(Index inputs, Index hidden, Index columns) {
  make_room(stacked, inputs + hidden, columns);
  make_room(cell, hidden, columns);
  make_room(gates, 4 * hidden, columns);
  stacked.leftCols(columns).setZero();
  cell.leftCols(columns).setZero();
}

void LstmCell::step(Index columns, LstmBatch& batch) const {
  const Index n = hidden();
  auto all = batch.gates.leftCols(columns);
  all.noalias() = gates.weight * batch.stacked.leftCols(columns);
  all.colwise() += gates.bias;
  all.topRows(2 * n) = all.topRows(2 * n).array().logistic();
  all.middleRows(2 * n, n) = all.middleRows(2 * n, n).array().tanh();
  all.bottomRows(n) = all.bottomRows(n).array().logistic();
  auto cell = batch.cell.leftCols(columns).array();
  cell = all.middleRows(n, n).array() * cell +
         all.topRows(n).array() * all.middleRows(2 * n, n).array();
  batch.stacked.bottomRows(n).leftCols(columns) = all.bottomRows(n).array() * cell.tanh();
}

Result<ResponseNetwork> parse_network(std::string_view text, const std::string& name) {
  Reader reader(text, name);
  if (!text.starts_with(kTitle)) {
    return fail(ErrorCode::kSyntax, "not a response network",
                fmt::format("the file begins with \"{}\"", kTitle), {name, 1, {}});
  }
  for (int i = 0; i < 3; ++i) reader.word();
  reader.expect("version");
  const int version = reader.number<int>();
  if (!reader.error() && version != kVersion) {
    reader.wrong(ErrorCode::kUnsupported, fmt::format("version {}", version),
                 fmt::format("this program reads version {}", kVersion));
  }
  ResponseNetwork network;
  reader.expect("step_s");
  network.step_s = reader.number<double>();
  reader.expect("past_steps");
  network.past_steps = reader.number<int>();
  if (!reader.error() && !(network.step_s >= 0.05 && network.step_s <= 2.0 &&
                           network.past_steps >= 0 && network.past_steps <= 50)) {
    reader.wrong(ErrorCode::kOutOfRange, "step_s or past_steps",
                 "allowed: 0.05 to 2 s, 0 to 50 steps");
  }
  for_each_layer(network, [&](std::string_view layer_name, LinearLayer& layer) {
    if (!reader.error()) read_layer(reader, layer_name, layer);
  });
  reader.expect("checksum");
  const std::string_view sum = reader.word();
  if (reader.error()) return tl::unexpected<Error>(*reader.error());
  if (sum != checksum(text.substr(0, text.rfind("checksum")))) {
    reader.wrong(ErrorCode::kSyntax, "the file has been changed: its checksum differs");
  } else if (const std::string layer = misfit(network); !layer.empty()) {
    reader.wrong(ErrorCode::kOutOfRange, fmt::format("the shape of \"{}\" does not fit", layer));
  }
  if (reader.error()) return tl::unexpected<Error>(*reader.error());
  return network;
}

Result<ResponseNetwork> load_network(const std::filesystem::path& file) {
  std::error_code code;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, code)) {
    return fail(ErrorCode::kFileNotFound, stream ? "is a directory" : "no such file",
                "name a network's weights, such as config/models/crowd_response.weights",
                {file.string(), 0, {}});
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_network(text, file.string());
}

std::string to_text(const ResponseNetwork& network) {
  std::string text = fmt::format("{}\nversion {}\nstep_s {}\npast_steps {}\n", kTitle, kVersion,
                                 network.step_s, network.past_steps);
  auto out = std::back_inserter(text);
  for_each_layer(network, [&](std::string_view layer_name, const LinearLayer& layer) {
    fmt::format_to(out, "layer {} {} {}\n", layer_name, layer.weight.rows(), layer.weight.cols());
    for (Index i = 0; i < layer.weight.rows(); ++i) {
      for (Index j = 0; j < layer.weight.cols(); ++j) {
        fmt::format_to(out, "{:.6g} ", layer.weight(i, j));
      }
      fmt::format_to(out, "{:.6g}\n", layer.bias(i));
    }
  });
  const std::string sum = checksum(text);
  return text + "checksum " + sum + "\n";
}

}  // namespace headland
