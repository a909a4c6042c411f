#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

Eigen::VectorXd CondensedBody::recover(const Eigen::VectorXd &u,
                                       const Eigen::VectorXd &multipliers)
{
   require(u.size() == S.rows(), "recover: ", u.size(), " contact displacements, must be ",
           S.rows());
   require(multipliers.size() == static_cast<Eigen::Index>(patterns.size()),
           "recover: ", multipliers.size(), " load multipliers, must be ", patterns.size());
   require(u.allFinite() && multipliers.allFinite(),
           "recover: a contact displacement or a load multiplier is not finite");
   ++counters.field_recoveries;
   const Eigen::VectorXd contact = FrameChange::of(line, held).transposed().rows(u);
   return solver->recover(contact(free_positions()), multipliers, counters);
}

std::vector<int> CondensedBody::free_positions() const
{
   const auto n = static_cast<int>(line.size());
   std::vector<int> positions;
   for (int row : held)
   {
      const int i = row % n;
      const LineNode &node = line.nodes[i];
      const Eigen::Vector2d axis = row < n ? node.tangent : node.normal();
      const bool both = std::binary_search(held.begin(), held.end(), row < n ? row + n : i);
      const int c =
         line.formulation == Formulation::torsion || both ? row / n : nearest_axis(axis);
      positions.push_back(c * n + i);
   }
   std::sort(positions.begin(), positions.end());
   return others(positions, S.rows());
}

double CondensedBody::error_estimate()
{
   // In global components, as the operator is.
   const bool twists = line.formulation == Formulation::torsion;
   const Eigen::VectorXd r = line.each(&LineNode::position).col(0);
   const FrameChange frames = FrameChange::of(line, held),
                     back = twists ? FrameChange{r, {}, {}, {}} : frames.inverse();
   Eigen::MatrixXd motions = free_motions;
   if (!twists)
   {
      motions = frames.transposed().rows(free_motions);
      if (!frames.rotates() && motions.cols() > 0) { motions = thin_qr(motions).Q; }
   }
   else if (motions.cols() > 0) // u_θ = r ψ
   {
      motions = r.cwiseInverse().asDiagonal() * motions;
      motions.col(0).normalize();
   }
   const std::vector<int> free = free_positions();
   Eigen::MatrixXd stiffness = back.both(S / thickness);
   if (!held.empty()) { stiffness = stiffness(free, free).eval(); }
   return solver->error(stiffness, motions(free, Eigen::all), counters);
}

void CondensedBody::thicken(double times)
{
   require(times > 0 && std::isfinite(times) && line.formulation == Formulation::plane,
           "condensed body: it becomes ", times, " times as thick, ",
           line.formulation == Formulation::plane
              ? "must be a positive, finite number of times"
              : "about an axis forces are those of the whole circumference");
   thickness *= times;
   S *= times;
   H *= times;
   for (LoadPattern &pattern : patterns)
   {
      pattern.q *= times;
      pattern.p *= times;
   }
}

Eigen::MatrixXd CondensedBody::rigid_motions() const
{
   const auto n = line.size();
   const auto position = line.each(&LineNode::position);
   if (line.formulation == Formulation::torsion) { return position.col(0); }
   const bool plane = line.formulation == Formulation::plane;
   Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(2 * n, plane ? 3 : 1);
   Z.col(plane ? 1 : 0).tail(n).setOnes();
   if (plane)
   {
      Z.col(0).head(n).setOnes();
      Z.col(2) << -position.col(1), position.col(0);
   }
   return FrameChange::of(line, held).inverse().transposed().rows(Z);
}

Eigen::Matrix2d CondensedBody::directions(Eigen::Index node) const
{
   const auto holds = [&](Eigen::Index row)
   { return std::binary_search(held.begin(), held.end(), static_cast<int>(row)); };
   return cattaneo::directions(line.nodes[node], holds(node), holds(node + line.size()));
}

bool CondensedBody::moves(Eigen::Index node, int component) const
{
   return moved.size() > 0 && !moved.row(component * line.size() + node).isZero(0);
}

bool CondensedBody::holds(Eigen::Index node, int component) const
{
   const bool along = nearest_axis(line.nodes[node].tangent) == component;
   const auto row = static_cast<int>(along ? node : node + line.size());
   return std::binary_search(held.begin(), held.end(), row);
}

} // namespace cattaneo
