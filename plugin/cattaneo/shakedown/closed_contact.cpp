#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>

namespace cattaneo
{

ClosedContact closed_contact(const ReducedProblem &problem,
                             const std::vector<Eigen::Index> &closed)
{
   problem.validate();
   const Eigen::Index n = problem.nodes(), c = problem.components();
   require(!closed.empty(), "closed contact: no node is closed, must be at least one");
   std::vector<bool> is_closed(n, false);
   for (const Eigen::Index i : closed)
   {
      require(i >= 0 && i < n, "closed contact: node ", i, ", must be from 0 to ", n - 1);
      require(!is_closed[i], "closed contact: node ", i,
              " is listed twice, must be listed once");
      require(problem.gap[i] == 0, "closed contact: node ", i, " has the gap ", problem.gap[i],
              ", must be zero (absorb_gap makes it a load pattern)");
      is_closed[i] = true;
   }
   ClosedContact contact;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      (is_closed[i] ? contact.closed : contact.open).push_back(i);
   }
   const auto n_closed = static_cast<Eigen::Index>(contact.closed.size());
   const auto n_open = static_cast<Eigen::Index>(contact.open.size());

   // Numbers of the unknowns of some nodes in {v; w}: each tangential component of all nodes,
   // then the normal one.
   const auto unknowns = [&](const std::vector<Eigen::Index> &nodes)
   {
      std::vector<Eigen::Index> list;
      for (Eigen::Index k = 0; k <= c; ++k)
      {
         for (const Eigen::Index i : nodes) { list.push_back(k * n + i); }
      }
      return list;
   };
   const std::vector<Eigen::Index> kept = unknowns(contact.closed),
                                   freed = unknowns(contact.open);
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   // The forces {q; p} of each load with the nodes clamped, one column for each pattern.
   Eigen::MatrixXd forces((c + 1) * n, patterns);
   Eigen::VectorXd sign(patterns); // of Fᵀ u in the conjugates of the loads
   for (Eigen::Index k = 0; k < patterns; ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      forces.col(k) << pattern.q, pattern.p;
      sign[k] = pattern.control == Control::force ? -1 : 1;
   }
   const Eigen::MatrixXd &K = problem.K;
   // Eliminates the motion of the open nodes, which carry no force: S = K_cc - K_co K_oo⁻¹
   // K_oc, and likewise for the load patterns and the response of the loads.
   Eigen::MatrixXd S = K(kept, kept), F = forces(kept, Eigen::all);
   Eigen::MatrixXd H = problem.H;
   Eigen::MatrixXd by_kept(freed.size(), kept.size()), by_load(freed.size(), patterns);
   if (n_open > 0)
   {
      DenseCholesky factor;
      // If the open nodes can move freely, their gaps are not determined and cannot be checked.
      require(factor.compute(K(freed, freed)), "closed contact: the motion of the ", n_open,
              " open nodes is not determined, because their stiffness is not positive "
              "definite: close more nodes, or support the bodies");
      by_kept = -factor.solved(K(freed, kept));
      by_load = -factor.solved(forces(freed, Eigen::all));
      S += K(kept, freed) * by_kept;
      S = (0.5 * (S + S.transpose())).eval();
      F += K(kept, freed) * by_load;
      if (problem.knows_loads())
      {
         H += sign.asDiagonal() * forces(freed, Eigen::all).transpose() * by_load;
      }
   }

   ReducedProblem &reduced = contact.reduced;
   const Eigen::Index m = c * n_closed;
   reduced.gap = Eigen::VectorXd::Zero(n_closed);
   // Motions without resistance move the open nodes as well. The round-off of their elimination
   // is removed.
   const Eigen::MatrixXd Q = thin_qr(problem.rigid_motions(kept, Eigen::all)).Q;
   S -= Q * (Q.transpose() * S);
   S -= (S * Q) * Q.transpose();
   reduced.K = 0.5 * (S + S.transpose());
   reduced.rigid_motions = Q;
   join_coupling(reduced);
   reduced.H = H;
   for (Eigen::Index k = 0; k < patterns; ++k)
   {
      reduced.patterns.push_back({problem.patterns[k].name, problem.patterns[k].control,
                                  F.col(k).head(m), F.col(k).tail(n_closed)});
   }
   // Data of the nodes are those of the closed ones, in the same order.
   reduced.friction = problem.friction(contact.closed);
   if (!problem.laws.empty())
   {
      for (const Eigen::Index i : contact.closed) { reduced.laws.push_back(problem.laws[i]); }
   }
   if (problem.weights.size()) { reduced.weights = problem.weights(contact.closed); }
   if (problem.arc_length.size()) { reduced.arc_length = problem.arc_length(contact.closed); }
   if (problem.position.size())
   {
      reduced.position = problem.position(contact.closed, Eigen::all);
   }
   if (problem.dofs.size()) { reduced.dofs = problem.dofs(contact.closed, Eigen::all); }

   // Chains of closed nodes that still follow each other. A chain that ends at an open node has
   // an `open` end there.
   const std::vector<Eigen::Index> &left = contact.closed;
   for (const ContactChain &chain : problem.chains)
   {
      const Eigen::Index last = chain.first + chain.nodes - 1;
      const auto gone = [&](Eigen::Index node)
      { return !std::binary_search(left.begin(), left.end(), node); };
      for (std::size_t k = 0; k < left.size(); ++k)
      {
         const Eigen::Index node = left[k];
         if (node < chain.first || node > last) { continue; }
         if (node == chain.first || gone(node - 1))
         {
            reduced.chains.push_back(chain);
            reduced.chains.back().first = static_cast<Eigen::Index>(k);
            reduced.chains.back().nodes = 0;
         }
         ContactChain &run = reduced.chains.back();
         const bool whole = ++run.nodes == chain.nodes;
         run.loop = chain.loop && whole;
         for (const std::size_t end : {0, 1})
         {
            const bool there = (!chain.loop || whole) &&
                               (end == 0 ? left[run.first] == chain.first : node == last);
            run.ends[end] = there ? chain.ends[end] : LineEnd::open;
            run.other_ends[end] = there ? chain.other_ends[end] : LineEnd::open;
         }
      }
   }
   for (Eigen::Index k = 0; k < m; ++k)
   {
      const auto &held = problem.held;
      if (std::count(held.begin(), held.end(), kept[k])) { reduced.held.push_back(k); }
   }

   // With w = 0 at the closed nodes the gaps of the open ones follow from slip and loads.
   contact.open_by_slip = by_kept.bottomLeftCorner(n_open, m);
   contact.open_by_load = by_load.bottomRows(n_open);
   contact.open_gap = problem.gap(contact.open);
   return contact;
}

Eigen::VectorXd ClosedContact::open_gaps(const Eigen::VectorXd &slip,
                                         const Eigen::VectorXd &multipliers) const
{
   return open_gap + open_by_slip * slip + open_by_load * multipliers;
}

StayedClosed stay_closed(const ReducedProblem &problem, const LoadCycle &cycle,
                         double load_factor, int cycles, const Monitor &monitor)
{
   cycle.validate(problem);
   require(cycles >= 1, "stay_closed: there are ", cycles, " cycles, must be at least 1");
   const Eigen::VectorXd rest = Eigen::VectorXd::Zero(cycle.constant.size());
   const LoadHistory history =
      cycle.history(load_factor, {rest, cycle.constant}, false, cycles);
   SlipRange slip(problem);
   const auto observe = [&](const ContactState &now, const IncrementRecord &record)
   {
      if (record.time >= 1) { slip.note(now); }
   };
   MarchSettings settings;
   settings.monitor = monitor;
   settings.every_event = true; // a node may open between two stops
   ContactState state = ContactState::virgin(problem);
   StayedClosed stayed;
   stayed.march = march(problem, history, state, settings, observe);
   for (std::size_t i = 0; i < slip.always_closed().size(); ++i)
   {
      if (slip.always_closed()[i]) { stayed.nodes.push_back(static_cast<Eigen::Index>(i)); }
   }
   return stayed;
}

} // namespace cattaneo
