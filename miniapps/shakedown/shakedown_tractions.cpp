#include "shakedown/shakedown_study.hpp"

#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// The residual shear that each load of the cycle leaves room for, -f p - q ≤ r ≤ f p - q.
void add_bounds(Panel &panel, const VectorXd &x, double f, const MatrixXd &q, const MatrixXd &p)
{
   const char *const loads[] = {"Qmax", "Qmin"};
   for (Index k = 0; k < 2; ++k)
   {
      panel.add(std::string("least at ") + loads[k], x, VectorXd(-f * p.col(k) - q.col(k)));
      panel.add(std::string("most at ") + loads[k], x, VectorXd(f * p.col(k) - q.col(k)));
   }
   panel.say("inside", "0.1"); // singular at the ends
}

/// First and last place among these nodes at which y is positive, linear between nodes; NaN if
/// it is positive nowhere.
std::pair<double, double> exceeded(const VectorXd &x, const NodeList &nodes, const VectorXd &y)
{
   double from = none, to = none;
   for (std::size_t k = 0; k < nodes.size(); ++k)
   {
      const Index i = nodes[k], before = nodes[k > 0 ? k - 1 : 0];
      const double zero = y[before] == y[i]
                             ? x[i]
                             : x[before] + (x[i] - x[before]) * y[before] / (y[before] - y[i]);
      if (y[i] > 0)
      {
         if (std::isnan(from)) { from = y[before] > 0 ? x[i] : zero; }
         to = x[i];
      }
      else if (k > 0 && y[before] > 0) { to = zero; }
   }
   return {from, to};
}

double at(const VectorXd &x, const VectorXd &y, double place)
{
   Index k = 1;
   while (k + 1 < x.size() && x[k] < place) { ++k; }
   return y[k - 1] + (y[k] - y[k - 1]) * (place - x[k - 1]) / (x[k] - x[k - 1]);
}

} // namespace

void Shakedown::draw_monolith()
{
   const auto lines = [&](const char *name, const std::string &title, const char *y) -> Panel &
   { return study.lines(name, title, "x/a", y); };
   const LoadPattern &P = problem.patterns[problem.pattern(held)],
                     &Q = problem.patterns[problem.pattern(cycled)];
   // Over the mean tractions P/2a and Q/2a; the thesis' shear is positive where Q is, as that
   // of the block on the plane.
   const VectorXd p_p = 2 * traction(P.p), q_p = -2 * traction(P.q), p_q = 2 * traction(Q.p),
                  q_q = -2 * traction(Q.q);
   Panel &by_p = lines("monolith_held", "Monolith, P alone", "p/p0, q/p0"),
         &by_q = lines("monolith_cycled", "Monolith, Q alone", "p/q0, q/q0"),
         &ratio = lines("traction_ratio", "Monolith: traction ratio under P and Q", "q/p");
   by_p.add("pressure p", x, p_p);
   by_p.add("shear q", x, q_p);
   by_q.add("pressure p", x, p_q);
   by_q.add("shear q", x, q_q);
   for (Panel *panel : {&by_p, &by_q}) { panel->say("inside", "0.1"); }
   const Index first = inner.front(), count = inner.back() - first + 1;
   for (const double load : {0.0, 0.2, 0.4, 0.6, 0.8})
   {
      const VectorXd p = (p_p + load * p_q).segment(first, count),
                     q = (q_p + load * q_q).segment(first, count);
      ratio.add(exact_text("λ = ", load), x.segment(first, count),
                VectorXd(q.cwiseQuotient(p)));
   }
   ResultTable &table = study.table("monolith", {{"x", "x/a", "%.1f"},
                                                 {"p_p", "p/p0, P"},
                                                 {"q_p", "q/p0, P"},
                                                 {"p_q", "p/q0, Q"},
                                                 {"q_q", "q/q0, Q"}});
   study.title("Tractions of the monolith");
   for (const double place : {0.0, 0.2, 0.5, 0.8})
   {
      study.row(table, {place, at(x, p_p, place), at(x, q_p, place), at(x, p_q, place),
                        at(x, q_q, place)});
   }
}

void Shakedown::draw_estimates(const Method2Estimate &second, double f1)
{
   const auto lines = [&](const char *name, const std::string &title, const char *y) -> Panel &
   { return study.lines(name, title, "x/a", y); };
   const StuckForces stuck = stuck_forces(problem, cycle);
   MatrixXd q = -stuck.q(lambda_max), p = stuck.p(lambda_max); // the thesis' sign
   for (MatrixXd *forces : {&q, &p})
   {
      *forces = forces->array().colwise() / problem.weights.array();
   }
   const auto extreme = [&](Index k, const char *name, const std::string &title)
   {
      Panel &panel = lines(name, title, "-a q/P, ± a f p/P");
      panel.add("q", x, VectorXd(q.col(k)));
      panel.add("f p", x, VectorXd(f1 * p.col(k)));
      panel.add("-f p", x, VectorXd(-f1 * p.col(k)));
      panel.say("inside", "0.1");
   };
   extreme(0, "at_largest", "Monolith at Qmax, f of method 1");
   extreme(1, "at_smallest", "Monolith at Qmin, f of method 1");
   const auto [from, to] = exceeded(x, inner, q.col(0) - f1 * p.col(0));
   study.value("exceeded_from", from, "q > f p of method 1 at Qmax, from x/a");
   study.value("exceeded_to", to, "to x/a");
   if (standard)
   {
      constexpr double of_thesis = 0.83; // its method 1
      const auto [first, last] = exceeded(x, inner, q.col(0) - of_thesis * p.col(0));
      study.value("exceeded_from_thesis", first, "q > 0.83 p, from x/a");
      study.value("exceeded_to_thesis", last, "to x/a");
   }
   add_bounds(lines("bounds", "Room for residual shear, method 1", "-a q/P"), x, f1, q, p);
   if (!second.exists) { return; }
   const VectorXd pressure = problem.weights.cwiseInverse().asDiagonal() *
                             (limit.residual.transfer * second.natural_residual);
   lines("method2_slip", "Slip of the residual shear without resultant", "v E'/P")
      .add("method 2", x, VectorXd(limit.residual.flexibility * second.natural_residual));
   Panel &residual =
      lines("method2_residual", "Residual tractions of that slip", "-a q/P, a p/P");
   residual.add("shear", x, VectorXd(-traction(second.natural_residual)));
   residual.add("pressure", x, pressure);
   residual.say("inside", "0.1");
   p.colwise() += pressure;
   add_bounds(lines("bounds_coupled", "Room with its pressure, f of method 1", "-a q/P"), x, f1,
              q, p);
   add_bounds(lines("bounds_method2", "Room with its pressure, f of method 2", "-a q/P"), x,
              second.natural, q, p);
}

} // namespace miniapp
