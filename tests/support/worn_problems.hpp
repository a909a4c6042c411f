#pragma once

#include "random_problem.hpp"

#include <cattaneo/wear/wear_march.hpp>
#include <cmath>

/// Small random contacts that wear, of several kinds, each by its seed.
namespace cattaneo_test
{

struct WornProblem
{
   cattaneo::ReducedProblem problem;
   cattaneo::LoadHistory history;
   cattaneo::WearLaw law;
   cattaneo::WearSettings settings; ///< with the stepping and the tolerance
   double cycles = 0;
};

/// Nodes in a row, each coupled with its neighbours, along and across; a parabola or a flat.
inline cattaneo::ReducedProblem random_row(int n, double friction, double coupling,
                                           std::mt19937 &random)
{
   using Eigen::MatrixXd;
   using Eigen::VectorXd;
   std::uniform_real_distribution<double> unit(0, 1);
   MatrixXd L = MatrixXd::Zero(n, n), J = L;
   for (int i = 0; i + 1 < n; ++i)
   {
      L(i, i) += 1;
      L(i + 1, i + 1) += 1;
      L(i, i + 1) = L(i + 1, i) = -1;
      J(i, i + 1) = -1;
      J(i + 1, i) = 1;
   }
   const MatrixXd I = MatrixXd::Identity(n, n);
   const double a = 0.2 + unit(random), c = 0.2 + unit(random);
   cattaneo::ReducedProblem problem;
   problem.set_stiffness(0.5 * I + a * L, coupling * J, 0.5 * I + c * L);
   const auto about = [&](double mean)
   { return VectorXd(VectorXd::NullaryExpr(n, [&] { return mean * (0.5 + unit(random)); })); };
   const VectorXd none = VectorXd::Zero(n);
   problem.patterns = {{"press", cattaneo::Control::force, none, about(1)},
                       {"shear", cattaneo::Control::force, about(1), none}};
   problem.H = MatrixXd::Identity(2, 2);
   const VectorXd x = VectorXd::LinSpaced(n, -1, 1);
   problem.gap = n > 1 ? VectorXd(unit(random) * x.cwiseAbs2()) : none;
   problem.weights = about(1);
   problem.chains = cattaneo::one_chain(n);
   set_friction(problem, friction);
   return problem;
}

/// Nodes that a rigid body drags to and fro, on an elastic foundation.
inline cattaneo::ReducedProblem random_dragged(int n, double friction, std::mt19937 &random)
{
   using Eigen::VectorXd;
   cattaneo::ReducedProblem problem = random_row(n, friction, 0, random);
   problem.patterns[1] = {"shear", cattaneo::Control::displacement,
                          -problem.A() * VectorXd::Ones(n), VectorXd::Zero(n)};
   return problem;
}

inline WornProblem random_worn_problem(int seed)
{
   using namespace cattaneo;
   std::mt19937 random(seed);
   std::uniform_real_distribution<double> unit(0, 1);
   const auto within = [&](double from, double to)
   { return from + (to - from) * unit(random); };
   const auto decades = [&](double from, double to) { return std::pow(10, within(from, to)); };
   WornProblem result;
   const int n = 1 + random() % 8, kind = random() % 4;
   const double friction = within(0.1, 0.7), coupling = random() % 3 ? within(0, 0.4) : 0.0;
   ReducedProblem &problem = result.problem;
   problem = kind == 0   ? random_problem(n, friction, coupling, random)
             : kind == 1 ? random_dragged(n, friction, random)
                         : random_row(n, friction, coupling, random);
   // Force enough to slip somewhere, most often not everywhere.
   const double Q = kind == 1 ? within(0.3, 3) : friction * within(0.1, 0.9),
                P = random() % 2 ? 1.0 : within(0.6, 1.4), back = -within(0.2, 1);
   result.history = LoadHistory::through(problem, {{},
                                                   {{"press", 1}},
                                                   {{"press", 1}, {"shear", Q}},
                                                   {{"press", P}, {"shear", back * Q}},
                                                   {{"press", 1}, {"shear", Q}}});
   result.history.cycle_start = 2;
   result.history.cycles = 1;
   result.cycles = std::round(decades(2.3, 3.6));
   WearSettings &settings = result.settings;
   settings.tolerance = decades(-4, -1);
   settings.march.stepping = random() % 2 ? Stepping::exact : Stepping::fixed;
   settings.march.increments = 1 + random() % 6;
   settings.update = random() % 20 ? GapUpdate::cycle : GapUpdate::piece;
   // So much wear that pressures change by a share between 1/30 and 30, were they not to fall.
   WearState once = WearState::virgin(problem);
   const double whole = decades(-1.5, 1.5);
   const WearLaw least = WearLaw::uniform(problem, 1e-6);
   double most = 0;
   if (wear(problem, least, result.history, 2, once).status == FrictionStatus::converged)
   {
      most = (problem.C() * once.depth).cwiseAbs().maxCoeff() / 2e-6;
   }
   result.law = WearLaw::uniform(problem, most > 0 ? whole / most / result.cycles : 1e-3);
   if (random() % 6 == 0) { result.law.threshold = Eigen::VectorXd::Constant(n, 0.1); }
   result.law.of_energy = random() % 6 == 0;
   return result;
}

} // namespace cattaneo_test
