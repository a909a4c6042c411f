#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/design/edge_response.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <functional>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

const ContactState &state_of(const MarchTrace &trace, std::size_t k)
{
   require(k < trace.states.size(), "edge responses: state ", k, ", must be below ",
           trace.states.size(), ", the number of states of the trace");
   return trace.states[k].state;
}

/// Tractions near an edge, and their nodes.
struct Near
{
   Near(const ReducedProblem &problem, const MarchTrace &trace, std::size_t k,
        const ContactEdge &edge, CrackedBody cracked)
      : problem(problem), trace(trace.number), k(k),
        sign(cracked == CrackedBody::first ? 1 : -1),
        tractions(edge_tractions(problem, state_of(trace, k), edge, cracked))
   {
      for (Index i = edge.first; i <= edge.last; ++i)
      {
         if (edge.side * (problem.arc_length[i] - tractions.edge) > 0) { nodes.push_back(i); }
      }
   }

   /// A number, with its derivatives by the pressure and the shear of each node.
   Response response(double value, const VectorXd &by_p, const VectorXd &by_q) const
   {
      const Index m = problem.slips();
      Response result;
      result.value = value;
      result.trace = trace;
      VectorXd &by = result.weights[k].forces = VectorXd::Zero(problem.K.rows());
      for (std::size_t j = 0; j < nodes.size(); ++j)
      {
         const Index i = nodes[j];
         if (!(problem.weights[i] > 0)) { continue; }
         by[m + i] = by_p[static_cast<Index>(j)] / problem.weights[i];
         if (m > 0) { by[i] = sign * by_q[static_cast<Index>(j)] / problem.weights[i]; }
      }
      return result;
   }

   /// A number that is linear in both.
   Response linear(const std::function<double(const EdgeTractions &)> &value) const
   {
      const auto count = static_cast<Index>(nodes.size());
      const double now = value(tractions);
      VectorXd by_p = VectorXd::Zero(count), by_q = by_p;
      for (auto [of, by] : {std::pair{&EdgeTractions::pressure, &by_p},
                            std::pair{&EdgeTractions::shear, &by_q}})
      {
         double unit = 0;
         for (const double x : tractions.*of) { unit = std::max(unit, std::abs(x)); }
         for (Index j = 0; j < count && unit > 0; ++j)
         {
            EdgeTractions other = tractions;
            const double step = (tractions.*of)[j] > 0 ? unit : -unit;
            (other.*of)[j] += step;
            (*by)[j] = (value(other) - now) / step;
         }
      }
      return response(now, by_p, by_q);
   }

   const ReducedProblem &problem;
   const std::uint64_t trace;
   const std::size_t k;
   const double sign;
   const EdgeTractions tractions;
   std::vector<Index> nodes;
};

FitSettings in_window(FitSettings settings, const FitWindow &window)
{
   settings.window = window;
   return settings;
}

/// Nodes without pressure count in a stuck contact.
EdgeTractions all_pressed(EdgeTractions tractions)
{
   std::fill(tractions.pressure.begin(), tractions.pressure.end(), 1.0);
   return tractions;
}

} // namespace

EdgeIntensities edge_intensities(const ReducedProblem &problem, const MarchTrace &trace,
                                 std::size_t state, const ContactEdge &edge,
                                 CrackedBody cracked, const FitSettings &settings)
{
   const Near near(problem, trace, state, edge, cracked);
   const FitSettings of_n = in_window(settings, fit_edge(near.tractions, settings).k_n.window),
                     of_t = in_window(
                        settings, fit_edge(all_pressed(near.tractions), settings).k_t.window);
   return {near.linear([&](const EdgeTractions &x) { return fit_edge(x, of_n).k_n.value; }),
           near.linear([&](const EdgeTractions &x)
                       { return fit_edge(all_pressed(x), of_t).k_t.value; })};
}

CornerIntensities corner_intensities(const ReducedProblem &problem, const MarchTrace &trace,
                                     std::size_t state, const ContactEdge &edge,
                                     const fretting::CornerModes &modes, CrackedBody cracked,
                                     const FitSettings &settings)
{
   const Near near(problem, trace, state, edge, cracked);
   const fretting::CornerFit now = fit_corner(modes, near.tractions, settings);
   const FitSettings fixed = in_window(settings, now.k_one.window);
   CornerIntensities result;
   result.k_one = near.linear([&](const EdgeTractions &x)
                              { return fit_corner(modes, x, fixed).k_one.value; });
   if (modes.two)
   {
      result.k_two = near.linear([&](const EdgeTractions &x)
                                 { return fit_corner(modes, x, fixed).k_two.value; });
   }
   return result;
}

MovingEdge moving_edge(const ReducedProblem &problem, const MarchTrace &trace,
                       std::size_t state, const ContactEdge &edge, const FitSettings &settings)
{
   require(edge.why_not.empty(), "moving edge: ", edge.why_not);
   const Near near(problem, trace, state, edge, CrackedBody::first);
   const EdgeTractions &tractions = near.tractions;
   const FitWindow window = fit_edge(tractions, settings).k_n.window;
   std::vector<Index> used;
   for (std::size_t j = 0; j < near.nodes.size(); ++j)
   {
      const double t = std::abs(tractions.position[j] - tractions.edge);
      if (tractions.pressure[j] > 0 && t >= window.nearest && t <= window.farthest)
      {
         used.push_back(static_cast<Index>(j));
      }
   }
   const auto count = static_cast<Index>(used.size()),
              all = static_cast<Index>(near.nodes.size());
   VectorXd t(count), square(count);
   for (Index j = 0; j < count; ++j)
   {
      t[j] = std::abs(tractions.position[used[j]] - tractions.edge) / window.farthest;
      square[j] = tractions.pressure[used[j]] * tractions.pressure[used[j]];
   }
   // c = solve · p²: the coefficients of the parabola. The rows of `solve` are their
   // derivatives by the values p².
   const MatrixXd terms = powers(t, 2);
   const MatrixXd solve = terms.colPivHouseholderQr().solve(MatrixXd::Identity(count, count));
   const Eigen::Vector3d c = solve * square;
   const double discriminant = c[1] * c[1] - 4 * c[0] * c[2];
   require(discriminant > 0 && c[1] > 0, "moving edge: the square of the pressure near arc ",
           "length ", tractions.edge, " has no zero: is it an edge of this state?");
   const double slope = std::sqrt(discriminant), zero = -2 * c[0] / (c[1] + slope),
                k_n = std::sqrt(slope / window.farthest);
   const Eigen::RowVectorXd of_zero =
      -(solve.row(0) + zero * solve.row(1) + zero * zero * solve.row(2)) / slope;
   const Eigen::RowVectorXd of_slope =
      solve.row(1) + 2 * zero * solve.row(2) + 2 * c[2] * of_zero;
   VectorXd position = VectorXd::Zero(all), intensity = position;
   for (Index j = 0; j < count; ++j)
   {
      const double by_p = 2 * tractions.pressure[used[j]];
      position[used[j]] = edge.side * window.farthest * by_p * of_zero[j];
      intensity[used[j]] = by_p * of_slope[j] / (2 * k_n * window.farthest);
   }
   const VectorXd none = VectorXd::Zero(all);
   return {near.response(tractions.edge + edge.side * window.farthest * zero, position, none),
           near.response(k_n, intensity, none)};
}

MarchTrace trace_stuck(const ReducedProblem &problem, const MarchTrace &trace,
                       std::size_t pressed, std::size_t loaded)
{
   require(pressed < loaded, "stuck trace: the contact is pressed in state ", pressed,
           " and loaded in state ", loaded, ", the loaded state must come later");
   const ContactState stuck =
      fully_stuck(problem, state_of(trace, pressed), state_of(trace, loaded));
   MarchTrace result = trace;
   result.states.erase(result.states.begin() + static_cast<std::ptrdiff_t>(pressed) + 1,
                       result.states.end());
   result.states.push_back(trace.states[loaded]);
   result.states.back().state = stuck;
   result.states.back().event = -1;
   return result;
}

} // namespace cattaneo
