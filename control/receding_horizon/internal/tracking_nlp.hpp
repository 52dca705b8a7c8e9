// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <coin/IpTNLP.hpp>

#include "control/receding_horizon/horizon_solver.hpp"

namespace headland::control::internal {

/// A HorizonProblem as Ipopt wants it. Variables u_0, x_1, u_1, x_2, ...: 7 an interval (x_0 is a
/// constant); constraints F(x_k, u_k) - x_{k+1} = 0: 5 an interval. The structure depends on the
/// number of intervals only.
class TrackingNlp : public Ipopt::TNLP {
 public:
  explicit TrackingNlp(int intervals);

  /// What is to be solved next, and where to start. The problem must outlive the solve.
  void set(const HorizonProblem& problem, const HorizonPlan& guess, const Deadline& deadline);
  const HorizonPlan& plan() const { return plan_; }
  bool timed_out() const { return timed_out_; }
  bool has_plan() const { return has_plan_; }

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& nnz_jac_g,
                    Ipopt::Index& nnz_h_lag, IndexStyleEnum& index_style) override;
  bool get_bounds_info(Ipopt::Index n, Ipopt::Number* x_l, Ipopt::Number* x_u, Ipopt::Index m,
                       Ipopt::Number* g_l, Ipopt::Number* g_u) override;
  bool get_starting_point(Ipopt::Index n, bool init_x, Ipopt::Number* x, bool init_z,
                          Ipopt::Number* z_l, Ipopt::Number* z_u, Ipopt::Index m, bool init_lambda,
                          Ipopt::Number* lambda) override;
  bool eval_f(Ipopt::Index n, const Ipopt::Number* x, bool new_x, Ipopt::Number& value) override;
  bool eval_grad_f(Ipopt::Index n, const Ipopt::Number* x, bool new_x,
                   Ipopt::Number* gradient) override;
  bool eval_g(Ipopt::Index n, const Ipopt::Number* x, bool new_x, Ipopt::Index m,
              Ipopt::Number* g) override;
  bool eval_jac_g(Ipopt::Index n, const Ipopt::Number* x, bool new_x, Ipopt::Index m,
                  Ipopt::Index nele_jac, Ipopt::Index* rows, Ipopt::Index* columns,
                  Ipopt::Number* values) override;
  bool eval_h(Ipopt::Index n, const Ipopt::Number* x, bool new_x, Ipopt::Number factor,
              Ipopt::Index m, const Ipopt::Number* lambda, bool new_lambda, Ipopt::Index nele_hess,
              Ipopt::Index* rows, Ipopt::Index* columns, Ipopt::Number* values) override;
  bool intermediate_callback(Ipopt::AlgorithmMode mode, Ipopt::Index iteration,
                             Ipopt::Number objective, Ipopt::Number inf_pr, Ipopt::Number inf_du,
                             Ipopt::Number mu, Ipopt::Number d_norm,
                             Ipopt::Number regularization_size, Ipopt::Number alpha_du,
                             Ipopt::Number alpha_pr, Ipopt::Index ls_trials,
                             const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* quantities) override;
  void finalize_solution(Ipopt::SolverReturn status, Ipopt::Index n, const Ipopt::Number* x,
                         const Ipopt::Number* z_l, const Ipopt::Number* z_u, Ipopt::Index m,
                         const Ipopt::Number* g, const Ipopt::Number* lambda,
                         Ipopt::Number objective, const Ipopt::IpoptData* data,
                         Ipopt::IpoptCalculatedQuantities* quantities) override;

 private:
  HorizonState state(const Ipopt::Number* x, int k) const;
  HorizonControl control(const Ipopt::Number* x, int k) const;

  int intervals_;
  const HorizonProblem* problem_ = nullptr;
  Deadline deadline_;
  HorizonPlan plan_;
  std::vector<double> low_price_, high_price_, multipliers_;
  bool timed_out_ = false;
  bool has_plan_ = false;
};

}  // namespace headland::control::internal
