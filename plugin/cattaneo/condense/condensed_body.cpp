#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

namespace
{

/// ReducedProblem::H, signs and symmetry, from the energies of clamped loads.
Eigen::MatrixXd load_by_load(const std::vector<BodyLoad> &loads, const ClampedLoads &clamped)
{
   const auto count = static_cast<Eigen::Index>(loads.size());
   const Eigen::MatrixXd &response = clamped.response, &reaction = clamped.reaction;
   Eigen::MatrixXd H(count, count);
   for (Eigen::Index k = 0; k < count; ++k)
   {
      for (Eigen::Index j = 0; j < count; ++j)
      {
         const bool force = loads[k].control == Control::force;
         double &h = H(k, j);
         if (loads[j].control == loads[k].control)
         {
            // Flexibility of forces, or stiffness of prescribed displacements.
            h = 0.5 * (response(k, j) + response(j, k));
            if (!force) { h = 0.5 * (reaction(j, k) + reaction(k, j)) - h; }
         }
         else
         {
            // Displacement of force f by motion d; the support's reaction is its opposite.
            const Eigen::Index f = force ? k : j, d = force ? j : k;
            h = reaction(f, d) + response(f, d);
            if (!force) { h = -h; }
         }
      }
   }
   return H;
}

} // namespace

std::vector<int> contact_dofs(const ContactLine &line, Formulation formulation, int dofs)
{
   const auto n = line.size();
   require(n > 0 && line.dofs.size() == static_cast<std::size_t>(n),
           "unsupported body: the contact line has ", n, " nodes and ", line.dofs.size(),
           " pairs of dofs, must have as many and at least one");
   std::vector<int> contact(components(formulation) * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (int c = 0; c < components(formulation); ++c)
      {
         const int dof = line.dofs[i][c];
         require(dof >= 0 && dof < dofs, "condense: contact dof ", dof, " of node ", i,
                 " of the line, must be from 0 to ", dofs - 1, " (is it a line of this body?)");
         contact[c * n + i] = dof;
      }
   }
   return contact;
}

void require_free(const ContactLine &line, Formulation formulation,
                  const std::vector<int> &fixed)
{
   if (fixed.empty()) { return; }
   const auto n = line.size();
   const Eigen::Index a = *std::min_element(fixed.begin(), fixed.end()), i = a % n;
   require(false, "condense: component ", component_name(formulation, static_cast<int>(a / n)),
           " of the contact node at (", line.position(i, 0), ", ", line.position(i, 1),
           ") is fixed or prescribed, contact nodes must be free");
}

CondensedBody in_local_frames(const ContactLine &line, Formulation formulation,
                              const std::vector<BodyLoad> &loads, Condensation found)
{
   CondensedBody result;
   result.line = line;
   result.formulation = formulation;
   result.counters = found.counters;
   result.solver = std::move(found.solver);
   result.rigid_modes = found.free.count;
   result.H = load_by_load(loads, found.clamped);
   const Equilibrium equilibrium(found.free);
   equilibrium.impose_on_stiffness(found.S);
   equilibrium.impose_on_forces(found.clamped.forces);
   const FrameChange frames = FrameChange::of(line, formulation);
   result.S = frames.both(found.S);
   // Displacements change with the frames as forces do, but for those of torsion, r times the
   // twist.
   const Eigen::MatrixXd &motions = equilibrium.motions();
   result.free_motions = formulation == Formulation::torsion
                            ? thin_qr(frames.a.cwiseInverse().asDiagonal() * motions).Q
                            : frames.rows(motions);
   if (loads.empty()) { return result; }
   const Eigen::MatrixXd local = frames.rows(found.clamped.forces);
   const auto n = line.size();
   for (std::size_t k = 0; k < loads.size(); ++k)
   {
      const auto force = local.col(static_cast<Eigen::Index>(k));
      result.patterns.push_back(
         {loads[k].name, loads[k].control, force.head(n), force.tail(local.rows() - n)});
   }
   return result;
}

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
   return solver->recover(FrameChange::of(line, formulation).transposed().rows(u), multipliers,
                          counters);
}

double CondensedBody::error_estimate()
{
   // In global components, as the operator is.
   const bool twists = formulation == Formulation::torsion;
   const FrameChange back = twists ? FrameChange{line.position.col(0), {}, {}, {}}
                                   : FrameChange::of(line, formulation).transposed();
   Eigen::MatrixXd motions = free_motions;
   if (!twists) { motions = back.rows(free_motions); }
   else if (motions.cols() > 0) // u_θ = r ψ
   {
      motions = line.position.col(0).cwiseInverse().asDiagonal() * motions;
      motions.col(0).normalize();
   }
   return solver->error(back.both(S), motions, counters);
}

Eigen::MatrixXd CondensedBody::rigid_motions() const
{
   const auto n = line.size();
   if (formulation == Formulation::torsion) { return line.position.col(0); }
   if (formulation == Formulation::axisymmetric)
   {
      Eigen::VectorXd along(2 * n);
      along << line.tangent.col(1), line.normal.col(1);
      return along;
   }
   Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(2 * n, 3);
   Z.col(0).head(n).setOnes();
   Z.col(1).tail(n).setOnes();
   Z.col(2).head(n) = -line.position.col(1);
   Z.col(2).tail(n) = line.position.col(0);
   return FrameChange::to_local(line.tangent, line.normal).rows(Z);
}

} // namespace cattaneo
