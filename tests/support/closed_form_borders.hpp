#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <string>
#include <vector>

namespace cattaneo_test
{

/// A border that zones() read out, and the closed form of the same.
struct KnownBorder
{
   bool found = false;                                    ///< the mesh has a zone to end there
   double exact = 0, read = 0, estimate = 0, spacing = 0; ///< lengths; spacing: at the border

   double error() const { return std::abs(read - exact); }
   bool inside() const { return found && error() <= estimate; }
};

/// Two equal half-planes, E = 1, ν = 0.3, that touch in a parabola 1/R = 1, pressed until the
/// contact is |x - middle| < 1.
struct Parabola
{
   std::vector<double> grid; ///< ends of the elements of the contact line, along x
   int order = 2;
   double middle = 0;
   double friction = 0.5;
   double shear = 0.5; ///< Q over f P, below 1
   double back_to = 1; ///< then Q goes to this share of it, from 1 down to -1
   double shift = 0; ///< of the stick zone at full Q, by tension of one body that grows with Q
};

inline KnownBorder known(double exact, bool found, const cattaneo::ZoneBorder &border,
                         const Eigen::VectorXd &arc)
{
   KnownBorder result{found, exact, border.position, border.error, 0};
   for (Eigen::Index i = 0; i + 1 < arc.size(); ++i)
   {
      if (arc[i + 1] >= exact && result.spacing == 0) { result.spacing = arc[i + 1] - arc[i]; }
   }
   return result;
}

/** The borders of its contact (2) and of its stick zone (2), as zones() has them, beside Hertz,
    Cattaneo and Mindlin: stick in |x - e| < c, c² = 1 - Q/fP, on first loading, and
    c² = 1 - (1 - back_to) Q/2fP after unloading. Tension in proportion to Q moves the stick
   zone by e (Hills and Nowell), as long as it stays inside the contact. Empty if there is no
    equilibrium. */
inline std::vector<KnownBorder> borders_of(const Parabola &of)
{
   using namespace cattaneo;
   HalfPlane pad, specimen;
   const double E_star = 1 / (2 * (1 - 0.3 * 0.3)), P = M_PI * E_star / 4, p0 = 2 * P / M_PI;
   pad.depth = specimen.depth = 1e4 * (of.grid.back() - of.grid.front());
   pad.normal = {0, 1};
   pad.forces = {{"P", {0, -P}}, {"Q", {of.shear * of.friction * P, 0}}};
   ReducedProblem problem = reduce(condense(pad, of.grid, of.order), specimen).problem;
   // Where the line lies along x: its arc length may run either way.
   const Eigen::VectorXd x = problem.position.col(0);
   const double way = x[x.size() - 1] > x[0] ? 1 : -1;
   const Eigen::VectorXd arc = problem.arc_length;
   const auto along = [&](double place) { return arc[0] + way * (place - x[0]); };
   problem.gap = 0.5 * (x.array() - of.middle).square().matrix();
   // Strain of one body: the surfaces move past each other by slope (x - middle).
   const double slope = of.shift * 2 * of.friction * p0 / E_star;
   Eigen::VectorXd apart = way * slope * (x.array() - of.middle).matrix();
   LoadPattern &pull = problem.patterns[problem.pattern("Q")];
   pull.q += problem.A() * apart;
   pull.p += problem.B() * apart;
   set_friction(problem, of.friction);
   std::vector<NamedLoads> points{{}, {{"P", 1}}, {{"P", 1}, {"Q", 1}}};
   if (of.back_to < 1) { points.push_back({{"P", 1}, {"Q", of.back_to}}); }
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(problem, LoadHistory::through(problem, points), state, settings);
   if (report.status != FrictionStatus::converged) { return {}; }
   const std::vector<Zone> all = zones(problem, state);
   const Zone contact = widest_zone(contact_zones(all), NodeState::stick),
              stick = widest_zone(all, NodeState::stick);
   const double share = of.back_to < 1 ? 0.5 * (1 - of.back_to) : 1;
   const double c = std::sqrt(1 - share * of.shear), e = of.middle + share * of.shift;
   std::vector<double> left{of.middle - 1, e - c}, right{of.middle + 1, e + c};
   if (way < 0) { std::swap(left, right); }
   std::vector<KnownBorder> borders;
   for (const std::size_t k : {0, 1})
   {
      const Zone &zone = k == 0 ? contact : stick;
      const bool found = zone.first <= zone.last;
      borders.push_back(known(along(left[k]), found, zone.from, arc));
      borders.push_back(known(along(right[k]), found, zone.to, arc));
   }
   return borders;
}

} // namespace cattaneo_test
