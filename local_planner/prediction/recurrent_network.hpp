// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "core/base/result.hpp"

namespace headland {

/// Room for `columns` columns of `rows` values: buffers grow by doubling and never shrink.
void make_room(Eigen::MatrixXf& matrix, Eigen::Index rows, Eigen::Index columns);

/// y = W x + b for a batch, one column each.
struct LinearLayer {
  Eigen::MatrixXf weight;  ///< outputs x inputs
  Eigen::VectorXf bias;    ///< outputs
};

/// What LSTM cells remember and work on, one column per sequence.
struct LstmBatch {
  Eigen::MatrixXf stacked;  ///< inputs above, hidden values below
  Eigen::MatrixXf cell;     ///< hidden x columns
  Eigen::MatrixXf gates;    ///< scratch, 4 hidden x columns

  /// Room for `columns` sequences, all at rest: hidden values, cells and inputs zero.
  void reset(Eigen::Index inputs, Eigen::Index hidden, Eigen::Index columns);
};

/// Long short-term memory (Hochreiter and Schmidhuber 1997, with the forget gate of Gers et al.
/// 2000). The gates' rows are those of input, forget, cell and output, in that order.
struct LstmCell {
  LinearLayer gates;  ///< 4 hidden x (inputs + hidden)

  Eigen::Index hidden() const { return gates.weight.rows() / 4; }
  Eigen::Index inputs() const { return gates.weight.cols() - hidden(); }
  /// One step of the first `columns` sequences, one matrix product for all of them: reads the
  /// inputs, moves hidden values and cells on.
  void step(Eigen::Index columns, LstmBatch& batch) const;
};

/// The learned response of agents to each other and to a robot (003, III-C.1): an encoder that has
/// seen how all moved, a decoder that moves them on with the robot's next position as an input,
/// and a head with a change of velocity and a growth of uncertainty per step. What the inputs mean
/// stands in response_features.hpp.
struct ResponseNetwork {
  double step_s = 0.4;   ///< between its steps
  int past_steps = 7;    ///< that the encoder looks back
  LinearLayer robot;     ///< what the robot means to an agent, before a ReLU
  LinearLayer neighbor;  ///< what another agent means to it, likewise; the most of all counts
  LstmCell encoder;
  LstmCell decoder;
  LinearLayer head;  ///< change of velocity (2) [m/s], log of growths of deviation (2), atanh(rho)
};

/// Reads a network from the text of its file; `name` stands for the file in errors: kSyntax (not
/// such a file, cut short, changed), kUnsupported (another version), kOutOfRange (a number that is
/// none, a shape that does not fit), each with its line.
Result<ResponseNetwork> parse_network(std::string_view text, const std::string& name);

/// Reads a network's file; kFileNotFound if that cannot be read.
Result<ResponseNetwork> load_network(const std::filesystem::path& file);

/// The text of a network's file. Weights are rounded to six digits.
std::string to_text(const ResponseNetwork& network);

}  // namespace headland
