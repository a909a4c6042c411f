#include <algorithm>
#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/condense/contact_dofs.hpp>
#include <cattaneo/condense/distributed_solver.hpp>
#include <cattaneo/condense/equal_operators.hpp>
#include <cattaneo/condense/free_motions.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cattaneo/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <numeric>

namespace cattaneo
{

/// Of a body on several ranks that was gathered, the first has all of this and the others
/// `contact` alone.
struct CondensedBody::Operator
{
   std::shared_ptr<const mfem::SparseMatrix> K;
   std::vector<int> essential; ///< sorted
   std::vector<int> keep;      ///< interior dofs, then x and then y of the contact nodes
   int contact = 0;            ///< number of contact dofs, 2n or (torsion) n
   double shift = 0.0;
   std::unique_ptr<SparseFactor> factor;
#ifdef MFEM_USE_MPI
   std::unique_ptr<DistributedSolver> distributed; ///< instead of all the above but `contact`
#endif
   Eigen::MatrixXd S; ///< in global components, {x; y}

   int interior() const
   {
      return static_cast<int>(keep.size()) - contact;
   }
};

struct CondensedBody::Loads
{
   Ranks ranks;              ///< that share the body
   int dofs = 0;             ///< true dofs of this rank
   Eigen::MatrixXd interior; ///< right-hand side of each pattern: F_I, or -K_ID d
   Eigen::MatrixXd
      contact; ///< (K + shift) U = {interior; 0} at the contact dofs, global components
   Eigen::MatrixXd prescribed;                 ///< d of each pattern at the essential dofs
   std::vector<ElasticBody::Pattern> patterns; ///< instead of these matrices if distributed
};

namespace
{

#ifdef MFEM_USE_MPI

std::shared_ptr<const CondensedBody::Operator>
distributed(const ElasticBody &body, const std::vector<int> &contact,
            const CondenseSettings &settings, const CondensedBody *alike, Counters &counters)
{
   auto op = std::make_shared<CondensedBody::Operator>();
   op->contact = static_cast<int>(contact.size());
   op->distributed =
      std::make_unique<DistributedSolver>(body, contact, settings.max_iterations);
   if (alike && alike->op && alike->op->distributed &&
       op->distributed->equals(*alike->op->distributed))
   {
      return alike->op;
   }
   op->S = op->distributed->schur(counters);
   ++counters.factorisations;
   return op;
}

#endif

std::shared_ptr<CondensedBody::Operator>
factored(const WholeBody &body, const std::vector<int> &contact, SparseFactor::Backend backend)
{
   auto op = std::make_shared<CondensedBody::Operator>();
   op->K = body.K;
   op->essential = body.essential;
   op->contact = static_cast<int>(contact.size());
   const mfem::SparseMatrix &K = *op->K;
   std::vector<bool> elsewhere(K.Height(), false);
   for (int dof : op->essential) { elsewhere[dof] = true; }
   for (int dof : contact) { elsewhere[dof] = true; }
   op->keep.reserve(K.Height() - op->essential.size());
   for (int dof = 0; dof < K.Height(); ++dof)
   {
      if (!elsewhere[dof]) { op->keep.push_back(dof); }
   }
   op->keep.insert(op->keep.end(), contact.begin(), contact.end());
   // With springs on the contact dofs a body needs no supports; S is freed of them exactly.
   for (int dof : contact) { op->shift += K(dof, dof) / static_cast<double>(contact.size()); }
   try
   {
      op->factor = std::make_unique<SparseFactor>(K, op->keep, op->contact, op->shift, backend);
   }
   catch (const NotPositiveDefinite &error)
   {
      const DofPlaces &places = body.places;
      require(false, "condense: the stiffness is not positive definite at component ",
              component_name(places.geometry, places.component[error.row]), " of the node (",
              places.x[error.row], ", ", places.y[error.row],
              "), it must be for every motion that leaves the supports at rest");
   }
   op->S = op->factor->schur();
   return op;
}

/// Loads of a body on one rank, and what is kept of them for recovery.
ClampedLoads clamp(const CondensedBody::Operator &op,
                   const std::vector<ElasticBody::Pattern> &patterns,
                   CondensedBody::Loads &loads, Counters &counters)
{
   // One column a pattern. K d is needed once more below, at contact and essential dofs.
   const auto count = static_cast<Eigen::Index>(patterns.size());
   const auto supports = op.essential.size();
   const int interior = op.interior(), size = static_cast<int>(op.keep.size());
   const int *contact = op.keep.data() + interior;
   loads.interior = Eigen::MatrixXd::Zero(interior, count);
   loads.contact = Eigen::MatrixXd::Zero(op.contact, count);
   loads.prescribed = Eigen::MatrixXd::Zero(supports, count);
   Eigen::MatrixXd at_contact(op.contact, count); // F_C, or -K_CD d
   Eigen::MatrixXd at_essential(supports, count); // F_D, or K_DD d
   mfem::Vector product(op.K->Height());
   for (Eigen::Index k = 0; k < count; ++k)
   {
      const bool force = patterns[k].control == Control::force;
      const mfem::Vector &values = patterns[k].values;
      if (!force) { op.K->Mult(values, product); }
      const mfem::Vector &source = force ? values : product;
      const double sign = force ? 1.0 : -1.0;
      for (int a = 0; a < interior; ++a) { loads.interior(a, k) = sign * source(op.keep[a]); }
      for (int a = 0; a < op.contact; ++a) { at_contact(a, k) = sign * source(contact[a]); }
      for (std::size_t a = 0; a < supports; ++a)
      {
         at_essential(a, k) = source(op.essential[a]);
         if (!force) { loads.prescribed(a, k) = values(op.essential[a]); }
      }
   }
   if (count == 0) { return {at_contact, loads.prescribed, loads.prescribed}; }
   Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(size, count);
   rhs.topRows(interior) = loads.interior;
   const Eigen::MatrixXd U = op.factor->solve(rhs);
   counters.back_substitutions += count;
   loads.contact = U.bottomRows(op.contact);
   // With springs on the contact nodes instead of clamps: K_CI K_II⁻¹ r = -(S + shift) U_C,
   // and r'ᵀ K_II⁻¹ r = r'ᵀ U_I - U'_Cᵀ (S + shift) U_C.
   const Eigen::MatrixXd released = op.S * loads.contact + op.shift * loads.contact;
   return {-released - at_contact,
           loads.interior.transpose() * U.topRows(interior) -
              loads.contact.transpose() * released,
           at_essential.transpose() * loads.prescribed};
}

/// What the ranks without a factor keep of it.
std::shared_ptr<const CondensedBody::Operator> without_factor(const std::vector<int> &contact)
{
   auto op = std::make_shared<CondensedBody::Operator>();
   op->contact = static_cast<int>(contact.size());
   return op;
}

/// What the first rank found, on all.
void share(const Ranks &ranks, Eigen::MatrixXd &S, FreeMotions &free, ClampedLoads &clamped,
           Counters &counters)
{
   if (!ranks.several()) { return; }
   Eigen::MatrixXd counts(3, 1);
   counts << free.count, counters.factorisations, counters.back_substitutions;
   for (Eigen::MatrixXd *matrix : {&counts, &S, &free.contact, &free.resultant, &clamped.forces,
                                   &clamped.response, &clamped.reaction})
   {
      ranks.share(*matrix);
   }
   free.count = static_cast<int>(counts(0));
   counters.factorisations = static_cast<long>(counts(1));
   counters.back_substitutions = static_cast<long>(counts(2));
}

/// ReducedProblem::H, signs and symmetry, from the energies of clamped loads.
Eigen::MatrixXd load_by_load(const std::vector<ElasticBody::Pattern> &patterns,
                             const ClampedLoads &clamped)
{
   const auto count = static_cast<Eigen::Index>(patterns.size());
   const Eigen::MatrixXd &response = clamped.response, &reaction = clamped.reaction;
   Eigen::MatrixXd H(count, count);
   for (Eigen::Index k = 0; k < count; ++k)
   {
      for (Eigen::Index j = 0; j < count; ++j)
      {
         const bool force = patterns[k].control == Control::force;
         double &h = H(k, j);
         if (patterns[j].control == patterns[k].control)
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

void CondenseSettings::validate() const
{
   require(formed_nodes >= 0, "condense: formed_nodes is ", formed_nodes,
           ", must not be negative");
   require(direct_dofs >= 0, "condense: direct_dofs is ", direct_dofs,
           ", must not be negative");
   require(max_iterations >= 1, "condense: max_iterations is ", max_iterations,
           ", must be at least 1");
}

CondensedBody condense(const ElasticBody &body, const ContactLine &line,
                       const CondenseSettings &settings, const CondensedBody *alike)
{
   settings.validate();
   const auto n = line.size();
   const Ranks &ranks = body.ranks();
   const std::vector<int> contact = contact_dofs(body, line);
   CondensedBody result;
   result.line = line;
   result.geometry = body.geometry();
   result.counters = body.counters();
   const auto &patterns = body.patterns();
   auto loads = std::make_shared<CondensedBody::Loads>();
   loads->ranks = ranks;
   loads->dofs = body.space().GetTrueVSize();
   FreeMotions free;
   ClampedLoads clamped;
   Eigen::MatrixXd S;
#ifdef MFEM_USE_MPI
   if (ranks.distributed() && body.dofs() > settings.direct_dofs)
   {
      free = find_free_motions(body, line);
      result.op = distributed(body, contact, settings, alike, result.counters);
      loads->patterns = patterns;
      clamped = result.op->distributed->loads(patterns, result.counters);
      S = result.op->S;
   }
   else
#endif
   {
      const WholeBody all = whole(body);
      const auto shares = [&](const CondensedBody::Operator &other)
      {
         return other.factor && other.essential == all.essential &&
                other.contact == static_cast<int>(contact.size()) &&
                std::equal(contact.begin(), contact.end(), other.keep.end() - other.contact) &&
                equal_operators(*other.K, *all.K);
      };
      ranks.on_first(
         [&]
         {
            free = find_free_motions(all, body.has_material(), contact);
            if (alike && alike->op && shares(*alike->op)) { result.op = alike->op; }
            else
            {
               result.op = factored(all, contact, settings.backend);
               ++result.counters.factorisations;
            }
            clamped = clamp(*result.op, all.patterns, *loads, result.counters);
            S = result.op->S;
         });
      if (!ranks.first()) { result.op = without_factor(contact); }
      share(ranks, S, free, clamped, result.counters);
   }
   result.rigid_modes = free.count;
   result.loads = std::move(loads);
   result.H = load_by_load(patterns, clamped);
   const Equilibrium equilibrium(free);
   equilibrium.impose_on_stiffness(S);
   equilibrium.impose_on_forces(clamped.forces);
   const FrameChange frames = FrameChange::of(line, body.geometry());
   result.S = frames.both(S);
   // Displacements change with the frames as forces do, but for those of torsion, r times the
   // twist.
   const Eigen::MatrixXd &motions = equilibrium.motions();
   result.free_motions = body.geometry() == Geometry::torsion
                            ? thin_qr(frames.a.cwiseInverse().asDiagonal() * motions).Q
                            : frames.rows(motions);
   if (patterns.empty()) { return result; }
   const Eigen::MatrixXd local = frames.rows(clamped.forces);
   for (std::size_t k = 0; k < patterns.size(); ++k)
   {
      const auto force = local.col(static_cast<Eigen::Index>(k));
      result.patterns.push_back(
         {patterns[k].name, patterns[k].control, force.head(n), force.tail(local.rows() - n)});
   }
   return result;
}

mfem::Vector CondensedBody::recover(const Eigen::VectorXd &u,
                                    const Eigen::VectorXd &multipliers)
{
   require(u.size() == op->contact, "recover: ", u.size(), " contact displacements, must be ",
           op->contact);
   require(multipliers.size() == static_cast<Eigen::Index>(patterns.size()),
           "recover: ", multipliers.size(), " load multipliers, must be ", patterns.size());
   require(u.allFinite() && multipliers.allFinite(),
           "recover: a contact displacement or a load multiplier is not finite");
   const Eigen::VectorXd contact = FrameChange::of(line, geometry).transposed().rows(u);
#ifdef MFEM_USE_MPI
   if (op->distributed)
   {
      ++counters.field_recoveries;
      mfem::Vector forces(op->distributed->size()), prescribed(forces.Size());
      forces = prescribed = 0.0;
      for (std::size_t k = 0; k < loads->patterns.size(); ++k)
      {
         const auto &pattern = loads->patterns[k];
         (pattern.control == Control::force ? forces : prescribed)
            .Add(multipliers[static_cast<Eigen::Index>(k)], pattern.values);
      }
      return op->distributed->recover(contact, forces, prescribed, counters);
   }
#endif
   ++counters.back_substitutions;
   ++counters.field_recoveries;
   Eigen::VectorXd field; // of all ranks
   if (loads->ranks.first())
   {
      const Eigen::VectorXd moved = contact - loads->contact * multipliers;
      Eigen::VectorXd rhs(op->keep.size());
      rhs.head(op->interior()) = loads->interior * multipliers;
      rhs.tail(op->contact) = op->S * moved + op->shift * moved;
      const Eigen::VectorXd U = op->factor->solve(rhs);
      field = Eigen::VectorXd::Zero(op->K->Height());
      for (int a = 0; a < op->interior(); ++a) { field[op->keep[a]] = U[a]; }
      // What was put in comes out to the last bit.
      for (int a = 0; a < op->contact; ++a)
      {
         field[op->keep[op->interior() + a]] = contact[a];
      }
      const Eigen::VectorXd prescribed = loads->prescribed * multipliers;
      for (std::size_t a = 0; a < op->essential.size(); ++a)
      {
         field[op->essential[a]] = prescribed[a];
      }
   }
   mfem::Vector here(loads->dofs);
   loads->ranks.deal(field, loads->dofs, here.GetData());
   return here;
}

double CondensedBody::error_estimate()
{
   // In global components, as the operator is.
   const bool twists = geometry == Geometry::torsion;
   const FrameChange back = twists ? FrameChange{line.position.col(0), {}, {}, {}}
                                   : FrameChange::of(line, geometry).transposed();
   const Eigen::MatrixXd global = back.both(S);
   Eigen::MatrixXd motions = free_motions;
   if (!twists) { motions = back.rows(free_motions); }
   else if (motions.cols() > 0) // u_θ = r ψ
   {
      motions = line.position.col(0).cwiseInverse().asDiagonal() * motions;
      motions.col(0).normalize();
   }
#ifdef MFEM_USE_MPI
   if (op->distributed)
   {
      const StiffnessProbes probe(global, motions);
      const Eigen::MatrixXd &u = probe.motions();
      mfem::Vector nothing(op->distributed->size());
      nothing = 0.0;
      Eigen::MatrixXd differences = global * u;
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
         differences.col(k) -= op->distributed->forces(
            op->distributed->recover(u.col(k), nothing, nothing, counters));
      }
      return probe.bound(differences);
   }
#endif
   Eigen::MatrixXd error(1, 1);
   loads->ranks.on_first(
      [&]
      {
         error(0) = stiffness_error(*op->K, op->keep, op->contact, op->shift, *op->factor,
                                    op->S, global, motions);
      });
   counters.back_substitutions += 6;
   if (loads->ranks.several()) { loads->ranks.share(error); }
   return error(0);
}

Eigen::MatrixXd CondensedBody::rigid_motions() const
{
   const auto n = line.size();
   if (geometry == Geometry::torsion) { return line.position.col(0); }
   if (geometry == Geometry::axisymmetric)
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
