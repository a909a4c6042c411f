#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/middles.hpp>
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
   Eigen::MatrixXd all = u;
   for (int row : held) { all.row(row).setZero(); }
   all = frames_of(*this).transposed().rows(all);
   if (const Middles middles(surface); !middles.none())
   {
      // The middle of an edge moves with ends that a load moves.
      if (moved.size() > 0) { all += moved * multipliers; }
      middles.to_nodes(all);
   }
   const Eigen::VectorXd contact = all;
   return solver->recover(contact(free_positions()), multipliers, counters);
}

std::vector<int> CondensedBody::free_positions() const
{
   const auto n = static_cast<int>(nodes());
   const auto is_held = [this](int row)
   { return std::binary_search(held.begin(), held.end(), row); };
   std::vector<int> positions;
   for (int row : held)
   {
      const int i = row % n;
      if (line.formulation == Formulation::space)
      {
         // A column of the frame is an axis, seen in the frame.
         const std::array<bool, 3> rows = {is_held(i), is_held(n + i), is_held(2 * n + i)};
         for (int c = 0; c < 3; ++c)
         {
            if (lies_in(surface.nodes[i].frame.col(c), rows))
            {
               positions.push_back(c * n + i);
            }
         }
         continue;
      }
      const LineNode &node = line.nodes[i];
      const Eigen::Vector2d axis = row < n ? node.tangent : node.normal();
      const bool both = is_held(row < n ? row + n : i);
      const int c =
         line.formulation == Formulation::torsion || both ? row / n : nearest_axis(axis);
      positions.push_back(c * n + i);
   }
   std::sort(positions.begin(), positions.end());
   positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
   return others(positions, S.rows());
}

Eigen::MatrixX3d CondensedBody::places() const
{
   return (surface.size() > 0 ? Trace(surface) : Trace(line)).position;
}

double CondensedBody::error_estimate()
{
   // In global components, as the operator is.
   const bool twists = line.formulation == Formulation::torsion;
   const FrameChange frames = frames_of(*this), back = frames.inverse();
   Eigen::MatrixXd motions = free_motions;
   if (!twists)
   {
      motions = frames.transposed().rows(free_motions);
      if (!frames.rotates() && motions.cols() > 0) { motions = thin_qr(motions).Q; }
   }
   else if (motions.cols() > 0) // u_θ = r ψ
   {
      motions = frames.rows(motions);
      motions.col(0).normalize();
   }
   const std::vector<int> free = free_positions();
   Eigen::MatrixXd stiffness = back.both(S / thickness);
   if (const Middles middles(surface); !middles.none())
   {
      middles.stiffness_to_nodes(stiffness);
      middles.to_nodes(motions);
      if (motions.cols() > 0) { motions = thin_qr(motions).Q; }
   }
   if (!held.empty()) { stiffness = stiffness(free, free).eval(); }
   return solver->error(stiffness, motions(free, Eigen::all), counters);
}

void CondensedBody::thicken(double times)
{
   require(times > 0 && std::isfinite(times) && line.formulation == Formulation::plane,
           "condensed body: the factor of the thickness is ", times,
           line.formulation == Formulation::plane
              ? ", must be positive and finite"
              : ", but only plane bodies have a thickness: forces about an axis are those of "
                "the whole circumference");
   thickness *= times;
   S *= times;
   H *= times;
   for (LoadPattern &pattern : patterns)
   {
      pattern.q *= times;
      pattern.p *= times;
   }
}

Eigen::MatrixXd CondensedBody::rigid_motions(const Eigen::Vector3d &centre) const
{
   const Eigen::MatrixX3d at = surface.size() > 0 ? surface.points() : places();
   const Eigen::Index n = at.rows();
   if (line.formulation == Formulation::torsion) { return at.col(0); }
   const int dimension = cattaneo::dimension(line.formulation);
   const bool axis = about_axis(line.formulation);
   Eigen::MatrixXd Z(dimension * n, axis ? 1 : 3 * (dimension - 1));
   for (Eigen::Index i = 0; i < n; ++i)
   {
      Eigen::MatrixXd own = rigid_at(at.row(i), centre, dimension);
      if (axis) { own = own.col(1).eval(); } // only along the axis
      for (int c = 0; c < dimension; ++c) { Z.row(c * n + i) = own.row(c); }
   }
   return frames_of(*this).inverse().transposed().rows(Z);
}

Eigen::MatrixXd CondensedBody::directions(Eigen::Index node) const
{
   if (line.formulation == Formulation::space) { return surface.nodes[node].frame.transpose(); }
   const auto holds = [&](Eigen::Index row)
   { return std::binary_search(held.begin(), held.end(), static_cast<int>(row)); };
   return cattaneo::directions(line.nodes[node], holds(node), holds(node + line.size()));
}

bool CondensedBody::moves(Eigen::Index node, int component) const
{
   return moved.size() > 0 && !moved.row(component * nodes() + node).isZero(0);
}

bool CondensedBody::holds(Eigen::Index node, int component) const
{
   if (line.formulation == Formulation::space)
   {
      // Frames contain the axes that supports hold.
      double part = 0;
      for (int k = 0; k < 3; ++k)
      {
         const auto row = static_cast<int>(node + k * surface.size());
         const double along = surface.nodes[node].frame(k, component);
         part += std::binary_search(held.begin(), held.end(), row) ? along * along : 0;
      }
      return part > 0.5;
   }
   const bool along = nearest_axis(line.nodes[node].tangent) == component;
   const auto row = static_cast<int>(along ? node : node + line.size());
   return std::binary_search(held.begin(), held.end(), row);
}

} // namespace cattaneo
