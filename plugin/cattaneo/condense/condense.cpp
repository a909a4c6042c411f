#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/row_links.hpp>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cattaneo/input_error.hpp>
#include <limits>
#include <map>

namespace cattaneo
{

namespace
{

/// Data that equal bodies share.
struct FactoredStiffness
{
   SharedMatrix K;
   std::vector<int> fixed; ///< sorted
   std::vector<int> keep;  ///< interior dofs, then the contact dofs
   int contact = 0;        ///< number of contact dofs
   double shift = 0.0;
   std::unique_ptr<SparseFactor> factor;

   int interior() const { return static_cast<int>(keep.size()) - contact; }
   bool stands_for(const AssembledBody &body, const std::vector<int> &contact_dofs) const
   {
      return fixed == body.fixed && contact == static_cast<int>(contact_dofs.size()) &&
             std::equal(contact_dofs.begin(), contact_dofs.end(), keep.end() - contact) &&
             K.equals(body.K);
   }
};

class FactorSolver : public BodySolver
{
public:
   std::shared_ptr<const FactoredStiffness> stiffness;
   Eigen::MatrixXd interior;   ///< right-hand side of each load: F_I, or -K_ID d
   Eigen::MatrixXd contact;    ///< (K + shift) U = {interior; 0} at the contact dofs
   Eigen::MatrixXd prescribed; ///< d of each load at the fixed dofs

   Eigen::VectorXd recover(const Eigen::VectorXd &displacements,
                           const Eigen::VectorXd &multipliers,
                           Counters &counters) const override
   {
      ++counters.back_substitutions;
      const FactoredStiffness &of = *stiffness;
      // The body follows the contact displacements less those that the loads alone would give.
      // The factor turns this difference into forces on its last dofs, and one solution then
      // gives the whole field.
      const Eigen::VectorXd moved = displacements - contact * multipliers;
      Eigen::VectorXd rhs(of.keep.size());
      rhs.head(of.interior()) = interior * multipliers;
      rhs.tail(of.contact) = of.factor->push(moved);
      Eigen::VectorXd U = of.factor->solve(rhs);
      U.tail(of.contact) = displacements; // the input, to the last bit
      Eigen::VectorXd field = Eigen::VectorXd::Zero(of.K.size());
      field(of.keep) = U;
      field(of.fixed) = prescribed * multipliers;
      return field;
   }
   double error(const Eigen::MatrixXd &S, const Eigen::MatrixXd &motions,
                Counters &counters) const override
   {
      const FactoredStiffness &of = *stiffness;
      counters.back_substitutions += 6;
      return stiffness_error(of.K, of.keep, of.contact, *of.factor, S, motions);
   }
};

/// In three dimensions the number of the node of each kept row, the same for rows at one place.
/// Otherwise empty.
std::vector<int> nodes_of(const std::vector<int> &keep, const DofPlaces &places)
{
   std::vector<int> numbers;
   if (places.formulation != Formulation::space) { return numbers; }
   std::map<std::array<double, 3>, int> known;
   for (int dof : keep)
   {
      const std::array<double, 3> at = {places.x[dof], places.y[dof], places.z[dof]};
      numbers.push_back(known.emplace(at, static_cast<int>(known.size())).first->second);
   }
   return numbers;
}

std::shared_ptr<const FactoredStiffness> factored(const AssembledBody &body,
                                                  const std::vector<int> &contact)
{
   auto made = std::make_shared<FactoredStiffness>();
   made->K = body.K;
   made->fixed = body.fixed;
   made->contact = static_cast<int>(contact.size());
   const int size = body.K.size();
   std::vector<bool> elsewhere(size, false);
   for (int dof : body.fixed) { elsewhere[dof] = true; }
   for (int dof : contact) { elsewhere[dof] = true; }
   made->keep.reserve(size - body.fixed.size());
   for (int dof = 0; dof < size; ++dof)
   {
      if (!elsewhere[dof]) { made->keep.push_back(dof); }
   }
   // The contact dofs go last, so that the trailing block of the factor is S.
   made->keep.insert(made->keep.end(), contact.begin(), contact.end());
   // Springs on the contact dofs make a body without supports positive definite. They are
   // subtracted from S exactly.
   for (int dof : contact)
   {
      made->shift += body.K.diagonal(dof) / static_cast<double>(contact.size());
   }
   require(made->shift >= 0,
           "condense: the stiffness of the contact nodes has a negative mean diagonal, ",
           made->shift,
           ", must be positive semidefinite (K u are the forces that cause the displacements "
           "u): is its sign wrong?");
   try
   {
      made->factor = std::make_unique<SparseFactor>(
         body.K.view(), made->keep, made->contact, made->shift,
         SparseFactor::Backend::automatic, nodes_of(made->keep, body.places));
   }
   catch (const NotPositiveDefinite &error)
   {
      const DofPlaces &places = body.places;
      require(
         false, "condense: the stiffness is not positive definite at component ",
         component_name(places.formulation, places.component[error.row]), " of the node ",
         places.called(error.row),
         ", must be positive definite for all displacements that leave the supports at rest");
   }
   return made;
}

/// InputError for a load whose displacements are so large that their forces, sums of |K||U|,
/// are lost in round-off. Such a load moves a part that only round-off holds: a part on a
/// single node, or a body without a support.
void require_held(const FactoredStiffness &of, const AssembledBody &body, const BodyLoad &load,
                  const Eigen::VectorXd &forces, const Eigen::VectorXd &U)
{
   if (forces.size() == 0) { return; } // all of the body is contact
   const double eps = std::numeric_limits<double>::epsilon(),
                all = forces.cwiseAbs().maxCoeff(), far = U.cwiseAbs().maxCoeff();
   const SparseView K = of.K.view();
   const Eigen::Map<const Eigen::VectorXd> entries(K.valuePtr(), K.nonZeros());
   // A cheap bound comes first. It suffices for bodies of up to some hundred entries in a row.
   if (1e3 * eps * entries.cwiseAbs().maxCoeff() * far <= 1e-3 * all) { return; }
   Eigen::VectorXd size = Eigen::VectorXd::Zero(of.K.size());
   size(of.keep) = U.cwiseAbs();
   Eigen::Index most = 0;
   size.maxCoeff(&most);
   const double left = eps * (K.cwiseAbs() * size).maxCoeff();
   require(!(left > 1e-3 * all), "condense: load '", load.name, "' moves the node ",
           body.places.called(static_cast<int>(most)), " by ", far,
           " per unit, so far that a share of ", left / all,
           " of its forces is round-off, must be at most 0.001: support the part that it "
           "pushes (a part held by a single node can turn)");
}

/// Effects of the loads of a body whose contact is clamped, with the data for the displacements
/// inside.
ClampedLoads clamp(const AssembledBody &body, FactorSolver &solver, Counters &counters)
{
   const std::vector<BodyLoad> &loads = body.loads;
   // One column per load. K d is needed once more below, at contact and fixed dofs.
   const FactoredStiffness &of = *solver.stiffness;
   const auto count = static_cast<Eigen::Index>(loads.size());
   const int interior = of.interior(), size = static_cast<int>(of.keep.size());
   const auto contact_dofs =
                 Eigen::Map<const Eigen::VectorXi>(of.keep.data() + interior, of.contact),
              interior_dofs = Eigen::Map<const Eigen::VectorXi>(of.keep.data(), interior);
   solver.interior = Eigen::MatrixXd::Zero(interior, count);
   solver.contact = Eigen::MatrixXd::Zero(of.contact, count);
   solver.prescribed = Eigen::MatrixXd::Zero(of.fixed.size(), count);
   Eigen::MatrixXd at_contact(of.contact, count);    // F_C, or -K_CD d
   Eigen::MatrixXd at_fixed(of.fixed.size(), count); // F_D, or K_DD d
   for (Eigen::Index k = 0; k < count; ++k)
   {
      const bool force = loads[k].control == Control::force;
      const Eigen::VectorXd &values = loads[k].values;
      const Eigen::VectorXd source = force ? values : Eigen::VectorXd(of.K.view() * values);
      const double sign = force ? 1.0 : -1.0;
      solver.interior.col(k) = sign * source(interior_dofs);
      at_contact.col(k) = sign * source(contact_dofs);
      at_fixed.col(k) = source(of.fixed);
      if (!force) { solver.prescribed.col(k) = values(of.fixed); }
   }
   if (count == 0) { return {at_contact, solver.prescribed, solver.prescribed}; }
   Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(size, count);
   rhs.topRows(interior) = solver.interior;
   const Eigen::MatrixXd U = of.factor->solve(rhs);
   counters.back_substitutions += count;
   for (Eigen::Index k = 0; k < count; ++k)
   {
      require_held(of, body, loads[k], solver.interior.col(k), U.col(k));
   }
   solver.contact = U.bottomRows(of.contact);
   // With springs on the contact nodes instead of clamps: K_CI K_II⁻¹ r = -(S + shift) U_C,
   // and r'ᵀ K_II⁻¹ r = r'ᵀ U_I - U'_Cᵀ (S + shift) U_C.
   const Eigen::MatrixXd released = of.factor->push(solver.contact);
   return {-released - at_contact,
           solver.interior.transpose() * U.topRows(interior) -
              solver.contact.transpose() * released,
           at_fixed.transpose() * solver.prescribed};
}

} // namespace

void require_in_place(const Trace &trace, const DofPlaces &places)
{
   const double box =
      (trace.position.colwise().maxCoeff() - trace.position.colwise().minCoeff()).maxCoeff();
   for (Eigen::Index i = 0; i < trace.size(); ++i)
   {
      const Eigen::Vector3d at = trace.position.row(i);
      const double allowed =
         1e-9 * std::max(box, trace.spacing[i]) + 1e-15 * at.lpNorm<Eigen::Infinity>();
      for (int c = 0; c < components(trace.formulation); ++c)
      {
         const int dof = trace.dofs(i, c);
         require(places.component[dof] == c && (places.place(dof) - at).norm() <= allowed,
                 "condense: dof ", dof, ", given as component ",
                 component_name(trace.formulation, c), " of node ", i, " of the ", trace.kind(),
                 ", at ", trace.called(i), ", is component ",
                 component_name(trace.formulation, places.component[dof]), " of the node ",
                 places.called(dof), " of the body, both must be the same");
      }
   }
}

namespace
{

/** A body whose blocks move. In its solver the blocks are held, at the displacements d. F are
    the clamped forces of all loads, among them the blocks' motions, and H is their response.
    Then

       d = H_dd⁻¹ (V ℓ - F_dᵀ u - H_dl ℓ),

    V the force of each load on each block. */
class BlockSolver : public BodySolver
{
public:
   std::shared_ptr<const BodySolver> held;
   Eigen::MatrixXd S, motions;          ///< of the body whose blocks are held
   Eigen::MatrixXd by_contact, by_load; ///< d = by_contact u + by_load ℓ

   Eigen::VectorXd recover(const Eigen::VectorXd &contact, const Eigen::VectorXd &multipliers,
                           Counters &counters) const override
   {
      Eigen::VectorXd all(multipliers.size() + by_load.rows());
      all << multipliers, by_contact * contact + by_load * multipliers;
      return held->recover(contact, all, counters);
   }
   double error(const Eigen::MatrixXd &, const Eigen::MatrixXd &,
                Counters &counters) const override
   {
      return held->error(S, motions, counters);
   }
};

Condensation with_blocks_held(AssembledBody body, const std::vector<int> &contact,
                              const BodySolver *alike);

} // namespace

Condensation condense_by_factor(const AssembledBody &body, const std::vector<int> &contact,
                                const BodySolver *alike)
{
   if (!body.blocks.empty()) { return with_blocks_held(body, contact, alike); }
   return condense_by_factor(body, contact, alike, find_free_motions(body, contact));
}

Condensation condense_by_factor(const AssembledBody &body, const std::vector<int> &contact,
                                const BodySolver *alike, FreeMotions free)
{
   Condensation found;
   found.free = std::move(free);
   auto solver = std::make_shared<FactorSolver>();
   const auto *other = dynamic_cast<const FactorSolver *>(alike);
   // A body with an equal operator, such as a shifted copy, has the same factor.
   if (other && other->stiffness->stands_for(body, contact))
   {
      solver->stiffness = other->stiffness;
   }
   else
   {
      solver->stiffness = factored(body, contact);
      ++found.counters.factorisations;
   }
   found.clamped = clamp(body, *solver, found.counters);
   found.S = solver->stiffness->factor->schur();
   found.solver = std::move(solver);
   return found;
}

namespace
{

Condensation with_blocks_held(AssembledBody body, const std::vector<int> &contact,
                              const BodySolver *alike)
{
   const FreeMotions free = find_free_motions(body, contact);
   // First condenses the body with its blocks fixed. Each block motion is a load of
   // displacements.
   const std::vector<BlockMotion> blocks = std::move(body.blocks);
   body.blocks.clear();
   const auto count = static_cast<Eigen::Index>(body.loads.size()),
              moved = static_cast<Eigen::Index>(blocks.size());
   Eigen::MatrixXd V = Eigen::MatrixXd::Zero(moved, count);
   Eigen::VectorXd sign(count);
   for (Eigen::Index k = 0; k < count; ++k)
   {
      sign[k] = body.loads[k].control == Control::force ? -1 : 1;
      for (Eigen::Index b = 0; b < moved; ++b)
      {
         if (blocks[b].load == body.loads[k].name) { V(b, k) = blocks[b].force; }
      }
   }
   for (const BlockMotion &block : blocks)
   {
      body.loads.push_back({"", Control::displacement, block.motion});
   }
   Condensation found = condense_by_factor(body, contact, alike);
   auto solver = std::make_shared<BlockSolver>();
   solver->S = found.S;
   solver->motions = Equilibrium(found.free).motions();
   const Eigen::MatrixXd H = load_by_load(body.loads, found.clamped);
   const Eigen::MatrixXd F = found.clamped.forces, F_d = F.rightCols(moved),
                         stiffness = H.bottomRightCorner(moved, moved),
                         felt = H.bottomLeftCorner(moved, count) - V;
   // The blocks then move until the forces on them vanish, which is a minimum of the energy. A
   // motion without resistance stays zero.
   solver->by_contact = -solve_semidefinite(stiffness, F_d.transpose());
   solver->by_load = -solve_semidefinite(stiffness, felt);
   // The energy at the minimum over d.
   found.S += F_d * solver->by_contact;
   found.S = (0.5 * (found.S + found.S.transpose())).eval();
   found.clamped.forces = F.leftCols(count) + F_d * solver->by_load;
   found.H =
      H.topLeftCorner(count, count) + sign.asDiagonal() * felt.transpose() * solver->by_load;
   found.free = free;
   solver->held = std::move(found.solver);
   found.solver = std::move(solver);
   return found;
}

} // namespace

AssembledBody with_eliminated(const AssembledBody &body)
{
   const std::vector<int> gone = body.grounded ? body.eliminated() : std::vector<int>();
   AssembledBody supported = body;
   if (gone.empty()) { return supported; }
   supported.fixed.clear();
   std::merge(body.fixed.begin(), body.fixed.end(), gone.begin(), gone.end(),
              std::back_inserter(supported.fixed));
   // Without these links, other rows may turn out to have no links either.
   supported.K = without_links(body.K, gone);
   return with_eliminated(supported);
}

namespace
{

/// Condenses to a line or a surface.
template <class Nodes>
CondensedBody condensed(const AssembledBody &given, const Nodes &line,
                        const CondensedBody *alike)
{
   given.validate();
   // Supports may have been eliminated by the program that wrote the stiffness.
   const AssembledBody body = with_eliminated(given);
   if (body.fixed.size() > given.fixed.size()) { body.validate(); }
   line.validate();
   const Trace trace(line);
   ContactDofs contact = contact_dofs(trace, body.places.formulation, body.K.size());
   require_in_place(trace, body.places);
   for (std::size_t a = 0; a < contact.all.size(); ++a)
   {
      if (!std::binary_search(body.fixed.begin(), body.fixed.end(), contact.all[a]))
      {
         continue;
      }
      const auto position = static_cast<int>(a);
      contact.held.push_back(position);
      if (moves_plane(trace, position, body.places, body.fixed, body.loads))
      {
         contact.in_moved_plane.push_back(position);
      }
      for (std::size_t k = 0; k < body.loads.size(); ++k)
      {
         const BodyLoad &load = body.loads[k];
         const double by =
            load.control == Control::displacement ? load.values[contact.all[a]] : 0.0;
         if (by != 0)
         {
            contact.move(position, static_cast<Eigen::Index>(k), by, trace, body.loads);
         }
      }
      for (const BlockMotion &block : body.blocks)
      {
         if (block.motion[contact.all[a]] != 0) { refuse_motion(trace, position, in_guide); }
      }
   }
   return in_local_frames(
      line, body.loads, contact,
      condense_by_factor(body, contact.free(), alike ? alike->solver.get() : nullptr));
}

} // namespace

CondensedBody condense(const AssembledBody &body, const ContactLine &line,
                       const CondensedBody *alike)
{
   return condensed(body, line, alike);
}

CondensedBody condense(const AssembledBody &body, const ContactSurface &surface,
                       const CondensedBody *alike)
{
   return condensed(body, surface, alike);
}

} // namespace cattaneo
