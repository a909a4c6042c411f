#include <algorithm>
#include <cattaneo/friction/settled_states.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Force below which a node counts as unloaded: a hundred times the solver's tolerance, and the
/// round-off of rigid displacements that are large compared with the deformation.
double least_force(const ReducedProblem &problem, const ContactState &state)
{
   double largest = 0;
   const auto stiff = [&](const auto &K, const VectorXd &u) // a view: nothing is copied
   {
      if (u.size())
      {
         largest = std::max(largest, K.diagonal().cwiseProduct(u).cwiseAbs().maxCoeff());
      }
   };
   stiff(problem.A(), state.v);
   stiff(problem.C(), state.w);
   return 1e-10 * state.peak_force + 1e-14 * largest;
}

} // namespace

VectorXd least_slip(const ReducedProblem &problem, const ContactState &state)
{
   const Index n = problem.nodes();
   if (problem.components() == 0) { return VectorXd::Zero(n); }
   return least_force(problem, state) * problem.A().diagonal().head(n).cwiseInverse();
}

std::vector<NodeState> settled_states(const ReducedProblem &problem, const ContactState &state)
{
   const Index n = problem.nodes();
   std::vector<NodeState> result = state.status;
   const VectorXd way = tangential_lengths(state.v - state.slip_origin, n);
   const VectorXd least = least_slip(problem, state);
   const double force = least_force(problem, state);
   const bool has_slip = problem.components() > 0, plane = problem.components() == 1;
   // Without friction, a contact that symmetry keeps at rest still moves by the errors of
   // integrals and coordinates.
   const VectorXd least_way =
      n > 0 ? VectorXd(least.cwiseMax(1e-8 * state.displacements().cwiseAbs().maxCoeff()))
            : VectorXd();
   const bool directed = plane && (way.array() > least_way.array()).any();
   std::vector<bool> held(n, false); // no law of friction holds for it
   for (Index row : problem.held) { held[row % n] = true; }
   for (Index i = 0; i < n; ++i)
   {
      NodeState &node = result[i];
      if (state.p[i] <= force) { node = NodeState::separation; }
      if (!closed(node)) { continue; }
      const bool free = has_slip && problem.friction[i] == 0 && !held[i];
      if (free)
      {
         const bool back = way[i] > least_way[i] && state.v[i] < state.slip_origin[i];
         node = !directed ? NodeState::slip
                : back    ? NodeState::backward_slip
                          : NodeState::forward_slip;
      }
      else if (way[i] <= least[i]) { node = NodeState::stick; }
   }
   return result;
}

Index touching_nodes(const ReducedProblem &problem, const ContactState &state)
{
   const double force = least_force(problem, state);
   Index count = 0;
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      const bool open = state.w[i] + problem.gap[i] > force / problem.C()(i, i);
      if (state.p[i] <= force && !open) { ++count; }
   }
   return count;
}

void SlipRange::start(const ContactState &state)
{
   low_ = high_ = state.v;
   closed_.assign(problem_->nodes(), true);
   note(state);
}

void SlipRange::note(const ContactState &state)
{
   if (low_.size() != state.v.size()) { return start(state); }
   low_ = low_.cwiseMin(state.v);
   high_ = high_.cwiseMax(state.v);
   const std::vector<NodeState> states = settled_states(*problem_, state);
   for (std::size_t i = 0; i < states.size(); ++i)
   {
      closed_[i] = closed_[i] && closed(states[i]);
   }
}

VectorXd SlipRange::range() const
{
   return tangential_lengths(high_ - low_, problem_->nodes());
}

} // namespace cattaneo
