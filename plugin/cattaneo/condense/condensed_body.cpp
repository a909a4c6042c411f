#include <algorithm>
#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/condense/distributed_solver.hpp>
#include <cattaneo/condense/equal_operators.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/rigid_motion.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <numeric>

namespace cattaneo
{

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
   Eigen::MatrixXd interior; ///< right-hand side of each pattern: F_I, or -K_ID d
   Eigen::MatrixXd
      contact; ///< (K + shift) U = {interior; 0} at the contact dofs, global components
   Eigen::MatrixXd prescribed;                 ///< d of each pattern at the essential dofs
   std::vector<ElasticBody::Pattern> patterns; ///< instead of all the above if distributed
};

namespace
{

DofPlaces places_of(const ElasticBody &body)
{
   const mfem::DenseMatrix &x = body.node_coordinates();
   const int dofs = body.stiffness().Height();
   DofPlaces places{Eigen::VectorXd::Zero(dofs), Eigen::VectorXd::Zero(dofs),
                    std::vector<int>(dofs, 0), body.geometry()};
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof < 0) { continue; }
         places.x[dof] = x(0, node);
         places.y[dof] = x(1, node);
         places.component[dof] = c;
      }
   }
   return places;
}

FrameChange frames_of(const ContactLine &line, Geometry geometry)
{
   return geometry == Geometry::torsion ? FrameChange::to_circumference(line.position.col(0))
                                        : FrameChange::to_local(line.tangent, line.normal);
}

/// Rigid motions that the supports leave free.
struct FreeMotions
{
   int count = 0;             ///< by geometry; those that K does not resist follow
   Eigen::MatrixXd contact;   ///< at the contact dofs, one column a motion
   Eigen::MatrixXd resultant; ///< work of each pattern's forces (columns) on each motion
};

/// InputError if some motions are left with the contact nodes held as well.
FreeMotions find_free_motions(const ElasticBody &body, const std::vector<int> &essential,
                              const std::vector<int> &contact)
{
   const mfem::SparseMatrix &K = body.stiffness();
   const DofPlaces places = places_of(body);
   std::vector<bool> supported(K.Height(), false);
   for (int dof : essential) { supported[dof] = true; }
   std::vector<bool> held = supported;
   for (int dof : contact) { held[dof] = true; }
   const auto count = static_cast<Eigen::Index>(body.patterns().size());
   FreeMotions free;
   free.contact.resize(contact.size(), 0);
   free.resultant.resize(0, count);
   const std::vector<std::vector<int>> parts = connected_parts(K);
   for (const std::vector<int> &part : parts)
   {
      const auto motions = [&](const std::vector<bool> &holding)
      {
         const Eigen::MatrixXd rigid = free_rigid_motions(places, part, holding);
         return body.has_material() ? rigid : unresisted(K, part, rigid);
      };
      const Eigen::MatrixXd still = motions(held);
      if (still.cols() > 0)
      {
         const int dof = part.front();
         require(false, "unsupported body: supports (", essential.size(),
                 " dofs) and contact nodes (", contact.size() / body.components(),
                 ") together leave ", still.cols(), " rigid motion(s) free",
                 parts.size() > 1 ? " of the separate part" : "",
                 " of the body with the node (", places.x[dof], ", ", places.y[dof],
                 "), must leave none");
      }
      // Elements of lower order than their geometry resist rotation a little: no equilibrium
      // there.
      const Eigen::MatrixXd possible = motions(supported);
      const Eigen::MatrixXd rigid = unresisted(K, part, possible);
      free.count += static_cast<int>(possible.cols());
      for (Eigen::Index m = 0; m < rigid.cols(); ++m)
      {
         Eigen::VectorXd whole = Eigen::VectorXd::Zero(K.Height());
         for (std::size_t k = 0; k < part.size(); ++k) { whole[part[k]] = rigid(k, m); }
         free.contact.conservativeResize(Eigen::NoChange, free.contact.cols() + 1);
         free.resultant.conservativeResize(free.resultant.rows() + 1, Eigen::NoChange);
         free.contact.rightCols(1) = whole(contact);
         for (Eigen::Index k = 0; k < count; ++k)
         {
            // Prescribed displacements strain the body; their forces do no work on rigid
            // motions.
            const auto &pattern = body.patterns()[k];
            const Eigen::Map<const Eigen::VectorXd> forces(pattern.values.GetData(),
                                                           K.Height());
            free.resultant(free.resultant.rows() - 1, k) =
               pattern.control == Control::force ? whole.dot(forces) : 0.0;
         }
      }
   }
   return free;
}

#ifdef MFEM_USE_MPI

/** The same of a body on several ranks, taken for connected, from what holds it: the places of
    the supports and of the contact nodes. */
FreeMotions find_free_motions(const ElasticBody &body, const ContactLine &line)
{
   // Two unheld corners of the bounding box carry the body's size.
   const Ranks &ranks = body.ranks();
   const mfem::DenseMatrix &x = body.node_coordinates();
   double box[4] = {-1e300, -1e300, -1e300, -1e300}; // -lo, hi
   std::vector<double> supports;
   const mfem::Array<int> essential = body.essential_dofs();
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < 2; ++c)
      {
         box[c] = std::max(box[c], -x(c, node));
         box[2 + c] = std::max(box[2 + c], x(c, node));
      }
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof >= 0 && std::binary_search(essential.begin(), essential.end(), dof))
         {
            supports.insert(supports.end(), {x(0, node), x(1, node), double(c)});
         }
      }
   }
   for (double &side : box) { side = ranks.max(side); }
   supports = ranks.gather(supports);
   const auto n = line.size();
   const int held = static_cast<int>(supports.size() / 3),
             contact = body.components() * static_cast<int>(n),
             count = held + contact + 2 * body.components();
   DofPlaces places{Eigen::VectorXd(count), Eigen::VectorXd(count), std::vector<int>(count),
                    body.geometry()};
   int k = 0;
   const auto add = [&](double px, double py, int component)
   {
      places.x[k] = px;
      places.y[k] = py;
      places.component[k++] = component;
   };
   for (int a = 0; a < held; ++a)
   {
      add(supports[3 * a], supports[3 * a + 1], static_cast<int>(supports[3 * a + 2]));
   }
   for (int c = 0; c < body.components(); ++c)
   {
      for (Eigen::Index i = 0; i < n; ++i) { add(line.position(i, 0), line.position(i, 1), c); }
   }
   for (int c = 0; c < body.components(); ++c)
   {
      add(-box[0], -box[1], c);
      add(box[2], box[3], c);
   }
   std::vector<int> all(count);
   std::iota(all.begin(), all.end(), 0);
   std::vector<bool> supported(count, false), both(count, false);
   std::fill(supported.begin(), supported.begin() + held, true);
   std::fill(both.begin(), both.begin() + held + contact, true);
   require(free_rigid_motions(places, all, both).cols() == 0, "unsupported body: supports (",
           held, " dofs) and contact nodes (", n,
           ") together leave rigid motions free, must leave none");
   const Eigen::MatrixXd rigid = free_rigid_motions(places, all, supported);

   // Each motion as a linear field of each component, from its values where the body is not
   // held, to find its work with the loads.
   const auto &patterns = body.patterns();
   FreeMotions free;
   free.count = static_cast<int>(rigid.cols());
   free.contact = rigid.middleRows(held, contact);
   free.resultant = Eigen::MatrixXd::Zero(rigid.cols(), patterns.size());
   for (Eigen::Index m = 0; m < rigid.cols(); ++m)
   {
      Eigen::MatrixXd field(3, body.components());
      for (int c = 0; c < body.components(); ++c)
      {
         const int corner = held + contact + 2 * c;
         Eigen::MatrixXd rows(n + 2, 3);
         Eigen::VectorXd values(n + 2);
         for (Eigen::Index i = 0; i < n + 2; ++i)
         {
            const auto at = i < n ? held + c * n + i : corner + i - n;
            rows.row(i) << 1, places.x[at], places.y[at];
            values[i] = rigid(at, m);
         }
         field.col(c) = rows.completeOrthogonalDecomposition().solve(values);
      }
      for (int node = 0; node < x.Width(); ++node)
      {
         for (int c = 0; c < body.components(); ++c)
         {
            const int dof = body.true_dof(node, c);
            if (dof < 0) { continue; }
            const double motion =
               field(0, c) + field(1, c) * x(0, node) + field(2, c) * x(1, node);
            for (std::size_t p = 0; p < patterns.size(); ++p)
            {
               if (patterns[p].control != Control::force) { continue; }
               free.resultant(m, static_cast<Eigen::Index>(p)) +=
                  motion * patterns[p].values(dof);
            }
         }
      }
   }
   ranks.sum(free.resultant);
   return free;
}

std::shared_ptr<const CondensedBody::Operator> distributed(const ElasticBody &body,
                                                           const std::vector<int> &contact,
                                                           const CondensedBody *alike,
                                                           Counters &counters)
{
   auto op = std::make_shared<CondensedBody::Operator>();
   op->contact = static_cast<int>(contact.size());
   op->distributed = std::make_unique<DistributedSolver>(body, contact);
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

/** Imposes on S and f (one column a pattern, both in global components) what is known of a free
    body: rigid motions meet no resistance, and the clamped contact balances the loads. In exact
    arithmetic this changes nothing. In floating point a motion that is large far from the
   contact (turning a half-plane of 10⁴ contact widths) would leave round-off of 10⁻⁴ of the
   stiffness. */
void impose_equilibrium(const FreeMotions &free, Eigen::MatrixXd &S, Eigen::MatrixXd &f)
{
   const Eigen::Index count = free.contact.cols();
   if (count == 0) { return; }
   const Eigen::HouseholderQR<Eigen::MatrixXd> qr(free.contact);
   const Eigen::MatrixXd Q =
      qr.householderQ() * Eigen::MatrixXd::Identity(free.contact.rows(), count);
   const Eigen::MatrixXd R = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
   const Eigen::MatrixXd SQ = S * Q;
   S += Q * (Q.transpose() * SQ) * Q.transpose() - Q * SQ.transpose() - SQ * Q.transpose();
   S = (0.5 * (S + S.transpose())).eval();
   // Contact forces and loads together do no work: (Q R)ᵀ f = -resultant.
   const Eigen::MatrixXd balance =
      -R.transpose().triangularView<Eigen::Lower>().solve(free.resultant);
   f += Q * (balance - Q.transpose() * f);
}

std::shared_ptr<const CondensedBody::Operator> factored(const ElasticBody &body,
                                                        const std::vector<int> &essential,
                                                        const std::vector<int> &contact,
                                                        SparseFactor::Backend backend)
{
   auto op = std::make_shared<CondensedBody::Operator>();
   op->K = body.shared_stiffness();
   op->essential = essential;
   op->contact = static_cast<int>(contact.size());
   const mfem::SparseMatrix &K = *op->K;
   std::vector<bool> elsewhere(K.Height(), false);
   for (int dof : essential) { elsewhere[dof] = true; }
   for (int dof : contact) { elsewhere[dof] = true; }
   op->keep.reserve(K.Height() - essential.size());
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
      const DofPlaces places = places_of(body);
      require(false, "condense: the stiffness is not positive definite at component ",
              component_name(body.geometry(), places.component[error.row]), " of the node (",
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

CondensedBody condense(const ElasticBody &body, const ContactLine &line,
                       const CondenseSettings &settings, const CondensedBody *alike)
{
   const auto n = line.size();
   require(n > 0 && line.true_dofs.size() == static_cast<std::size_t>(n),
           "unsupported body: the contact line has ", n, " nodes and ", line.true_dofs.size(),
           " pairs of dofs, must have as many and at least one");
   const Ranks &ranks = body.ranks();
   const mfem::Array<int> essential_dofs = body.essential_dofs();
   const std::vector<int> essential(essential_dofs.begin(), essential_dofs.end());
   const int components = body.components(), first = body.first_global_dof();
   const int dofs = body.dofs();
   std::vector<int> contact(components * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (int c = 0; c < components; ++c)
      {
         const int dof = line.true_dofs[i][c];
         require(dof >= 0 && dof < dofs, "condense: contact dof ", dof, " of node ", i,
                 " of the line, must be from 0 to ", dofs - 1, " (is it a line of this body?)");
         contact[c * n + i] = dof;
      }
   }
   // On all ranks alike, the owner of a dof knows.
   std::vector<double> fixed;
   for (std::size_t a = 0; a < contact.size(); ++a)
   {
      if (std::binary_search(essential.begin(), essential.end(), contact[a] - first))
      {
         fixed.push_back(static_cast<double>(a));
      }
   }
   fixed = ranks.gather(fixed);
   if (!fixed.empty())
   {
      const auto a = static_cast<Eigen::Index>(*std::min_element(fixed.begin(), fixed.end()));
      require(false, "condense: component ", component_name(body.geometry(), a / n),
              " of the contact node at (", line.position(a % n, 0), ", ",
              line.position(a % n, 1), ") is fixed or prescribed, contact nodes must be free");
   }

   CondensedBody result;
   result.line = line;
   result.geometry = body.geometry();
   result.counters = body.counters();
   const auto &patterns = body.patterns();
   auto loads = std::make_shared<CondensedBody::Loads>();
   FreeMotions free;
   ClampedLoads clamped;
#ifdef MFEM_USE_MPI
   if (ranks.several())
   {
      free = find_free_motions(body, line);
      result.op = distributed(body, contact, alike, result.counters);
      loads->patterns = patterns;
      clamped = result.op->distributed->loads(patterns, result.counters);
   }
   else
#endif
   {
      free = find_free_motions(body, essential, contact);
      const auto shares = [&](const CondensedBody::Operator &other)
      {
         return other.essential == essential &&
                other.contact == static_cast<int>(contact.size()) &&
                std::equal(contact.begin(), contact.end(), other.keep.end() - other.contact) &&
                equal_operators(*other.K, body.stiffness());
      };
      if (alike && alike->op && shares(*alike->op)) { result.op = alike->op; }
      else
      {
         result.op = factored(body, essential, contact, settings.backend);
         ++result.counters.factorisations;
      }
      clamped = clamp(*result.op, patterns, *loads, result.counters);
   }
   result.rigid_modes = free.count;
   result.loads = std::move(loads);
   result.H = load_by_load(patterns, clamped);
   Eigen::MatrixXd S = result.op->S;
   impose_equilibrium(free, S, clamped.forces);
   const FrameChange frames = frames_of(line, body.geometry());
   result.S = frames.both(S);
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
   const Eigen::VectorXd contact = frames_of(line, geometry).transposed().rows(u);
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
   const Eigen::VectorXd moved = contact - loads->contact * multipliers;
   Eigen::VectorXd rhs(op->keep.size());
   rhs.head(op->interior()) = loads->interior * multipliers;
   rhs.tail(op->contact) = op->S * moved + op->shift * moved;
   const Eigen::VectorXd U = op->factor->solve(rhs);
   ++counters.back_substitutions;
   ++counters.field_recoveries;

   mfem::Vector field(op->K->Height());
   field = 0.0;
   for (int a = 0; a < op->interior(); ++a) { field(op->keep[a]) = U[a]; }
   // What was put in comes out to the last bit.
   for (int a = 0; a < op->contact; ++a) { field(op->keep[op->interior() + a]) = contact[a]; }
   const Eigen::VectorXd prescribed = loads->prescribed * multipliers;
   for (std::size_t a = 0; a < op->essential.size(); ++a)
   {
      field(op->essential[a]) = prescribed[a];
   }
   return field;
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
