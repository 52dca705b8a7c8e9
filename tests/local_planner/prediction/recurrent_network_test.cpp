// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/recurrent_network.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/local_planner/prediction/random_network.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;

double sigmoid(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// One step of one sequence, gate by gate, in doubles.
void plain_step(const LstmCell& cell, const std::vector<double>& input, std::vector<double>& hidden,
                std::vector<double>& memory) {
  const std::vector<double> before = hidden;
  const std::size_t n = hidden.size();
  const auto gate = [&](std::size_t row) {
    const auto r = static_cast<Eigen::Index>(row);
    double sum = cell.gates.bias(r);
    for (std::size_t j = 0; j < input.size() + n; ++j) {
      const double x = j < input.size() ? input[j] : before[j - input.size()];
      sum += cell.gates.weight(r, static_cast<Eigen::Index>(j)) * x;
    }
    return sum;
  };
  for (std::size_t i = 0; i < n; ++i) {
    memory[i] = sigmoid(gate(n + i)) * memory[i] + sigmoid(gate(i)) * std::tanh(gate(2 * n + i));
    hidden[i] = sigmoid(gate(3 * n + i)) * std::tanh(memory[i]);
  }
}

TEST(RecurrentNetwork, CellsStepAsTheEquationsSaySequenceBySequence) {
  const LstmCell cell = testing::random_network(1).encoder;
  const auto inputs = static_cast<std::size_t>(cell.inputs());
  const auto hidden = static_cast<std::size_t>(cell.hidden());
  RandomStream random(2, "inputs");
  LstmBatch batch;
  batch.reset(cell.inputs(), cell.hidden(), 3);
  std::vector<std::vector<double>> h(3, std::vector<double>(hidden, 0.0));
  std::vector<std::vector<double>> c = h;
  for (int step = 0; step < 6; ++step) {
    for (std::size_t s = 0; s < 3; ++s) {
      std::vector<double> input(inputs);
      for (std::size_t j = 0; j < inputs; ++j) {
        input[j] = random.normal();
        batch.stacked(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(s)) =
            static_cast<float>(input[j]);
      }
      plain_step(cell, input, h[s], c[s]);
    }
    cell.step(3, batch);
    for (std::size_t s = 0; s < 3; ++s) {
      for (std::size_t i = 0; i < hidden; ++i) {
        const auto column = static_cast<Eigen::Index>(s);
        const auto row = static_cast<Eigen::Index>(i);
        ASSERT_NEAR(batch.stacked(cell.inputs() + row, column), h[s][i], 1e-5);
        ASSERT_NEAR(batch.cell(row, column), c[s][i], 1e-5);
      }
    }
  }
}

TEST(RecurrentNetwork, TextsAreReadAsTheyWereWritten) {
  const ResponseNetwork network = testing::random_network(3);
  const std::string text = to_text(network);
  const auto read = parse_network(text, "net");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(to_text(*read), text);
  EXPECT_EQ(read->past_steps, network.past_steps);
  EXPECT_LT((read->decoder.gates.weight - network.decoder.gates.weight).cwiseAbs().maxCoeff(),
            1e-5);
  EXPECT_LT((read->head.bias - network.head.bias).cwiseAbs().maxCoeff(), 1e-5);
}

// ---- Files that are wrong

std::string good() { return to_text(testing::random_network(4)); }

// The text with a piece replaced, and a checksum that is right again.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = good();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  text.resize(text.rfind("checksum"));
  return text + fmt::format("checksum {:016x}\n", fnv1a(text));
}

Error error_of(const std::string& text) {
  const auto read = parse_network(text, "net.weights");
  EXPECT_FALSE(read);
  return read ? Error{} : read.error();
}

TEST(RecurrentNetwork, AFileOfAnotherKindIsRefused) {
  for (const std::string text : {"", "weights", "{\"a\": 1}"}) {
    EXPECT_EQ(error_of(text).code, ErrorCode::kSyntax);
    EXPECT_THAT(to_string(error_of(text)), HasSubstr("net.weights:1: "));
  }
}

TEST(RecurrentNetwork, AFileThatIsNotThereIsSaidToBeMissing) {
  for (const char* path : {"/nowhere/net.weights", "/"}) {
    const auto loaded = load_network(path);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, ErrorCode::kFileNotFound);
    EXPECT_THAT(to_string(loaded.error()), HasSubstr(path));
  }
}

TEST(RecurrentNetwork, AFileCutAnywhereIsRefused) {
  const std::string text = good();
  for (std::size_t size = 0; size + 2 < text.size(); size += 97) {
    ASSERT_EQ(error_of(text.substr(0, size)).code, ErrorCode::kSyntax) << size;
  }
  EXPECT_THAT(error_of(text.substr(0, text.size() / 2)).what, HasSubstr("cut short"));
}

TEST(RecurrentNetwork, AnotherVersionIsRefused) {
  const Error error = error_of(changed("version 1", "version 2"));
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.where.line, 2);
  EXPECT_THAT(error.remedy, HasSubstr("version 1"));
}

TEST(RecurrentNetwork, AWeightThatIsNoNumberIsRefusedWithItsLine) {
  const std::string head = "layer robot 5 10\n";
  const std::string text = good();
  const std::size_t begin = text.find(head) + head.size();
  const std::string first = text.substr(begin, text.find(' ', begin) - begin);
  for (const std::string wrong : {"nan", "inf", "-inf"}) {
    const Error error = error_of(changed(head + first, head + wrong));
    EXPECT_EQ(error.code, ErrorCode::kOutOfRange) << wrong;
    EXPECT_EQ(error.where.line, 6) << wrong;
  }
  EXPECT_EQ(error_of(changed(head + first, head + "0.1x")).code, ErrorCode::kSyntax);
}

TEST(RecurrentNetwork, AChangedWeightIsFoundByTheChecksum) {
  std::string text = good();
  const std::size_t digit = text.find_first_of("123456789", text.find("layer head 5 8") + 20);
  text[digit] = text[digit] == '1' ? '2' : '1';
  EXPECT_THAT(error_of(text).what, HasSubstr("checksum"));
}

TEST(RecurrentNetwork, ShapesThatDoNotFitAreRefused) {
  ResponseNetwork network = testing::random_network(5);
  network.head = LinearLayer{Eigen::MatrixXf::Zero(4, 8), Eigen::VectorXf::Zero(4)};
  EXPECT_EQ(error_of(to_text(network)).code, ErrorCode::kOutOfRange);
  network = testing::random_network(5);
  network.decoder = testing::random_network(5, 6).decoder;
  EXPECT_THAT(error_of(to_text(network)).what, HasSubstr("decoder"));
  EXPECT_EQ(error_of(changed("layer robot 5 10", "layer robot 5 100000")).code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(error_of(changed("step_s 0.4", "step_s 0")).code, ErrorCode::kOutOfRange);
}

}  // namespace
}  // namespace headland
