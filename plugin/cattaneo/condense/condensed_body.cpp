#include <algorithm>
#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/rigid_motion.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

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
   Eigen::MatrixXd S; ///< in global components, {x; y}

   int interior() const { return static_cast<int>(keep.size()) - contact; }
};

struct CondensedBody::Loads
{
   Eigen::MatrixXd interior; ///< right-hand side of each pattern: F_I, or -K_ID d
   Eigen::MatrixXd
      contact; ///< (K + shift) U = {interior; 0} at the contact dofs, global components
   Eigen::MatrixXd prescribed; ///< d of each pattern at the essential dofs
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

bool equal_operators(const mfem::SparseMatrix &A, const mfem::SparseMatrix &B)
{
   if (&A == &B) { return true; }
   const int n = A.Height(), entries = A.NumNonZeroElems();
   if (B.Height() != n || B.NumNonZeroElems() != entries ||
       !std::equal(A.GetI(), A.GetI() + n + 1, B.GetI()) ||
       !std::equal(A.GetJ(), A.GetJ() + entries, B.GetJ()))
   {
      return false;
   }
   const Eigen::Map<const Eigen::VectorXd> a(A.GetData(), entries), b(B.GetData(), entries);
   return (a - b).lpNorm<Eigen::Infinity>() <= 1e-12 * a.lpNorm<Eigen::Infinity>();
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

} // namespace

CondensedBody condense(const ElasticBody &body, const ContactLine &line,
                       const CondenseSettings &settings, const CondensedBody *alike)
{
   const mfem::SparseMatrix &K = body.stiffness();
   const auto n = line.size();
   require(n > 0 && line.true_dofs.size() == static_cast<std::size_t>(n),
           "unsupported body: the contact line has ", n, " nodes and ", line.true_dofs.size(),
           " pairs of dofs, must have as many and at least one");
   const mfem::Array<int> essential_dofs = body.essential_dofs();
   const std::vector<int> essential(essential_dofs.begin(), essential_dofs.end());
   const int components = body.components();
   std::vector<int> contact(components * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (int c = 0; c < components; ++c)
      {
         const int dof = line.true_dofs[i][c];
         require(dof >= 0 && dof < K.Height(), "condense: contact dof ", dof, " of node ", i,
                 " of the line, must be from 0 to ", K.Height() - 1,
                 " (is it a line of this body?)");
         require(!std::binary_search(essential.begin(), essential.end(), dof),
                 "condense: component ", component_name(body.geometry(), c),
                 " of the contact node at (", line.position(i, 0), ", ", line.position(i, 1),
                 ") is fixed or prescribed, contact nodes must be free");
         contact[c * n + i] = dof;
      }
   }

   CondensedBody result;
   result.line = line;
   result.geometry = body.geometry();
   result.counters = body.counters();
   const FreeMotions free = find_free_motions(body, essential, contact);
   result.rigid_modes = free.count;
   const auto shares = [&](const CondensedBody::Operator &other)
   {
      return other.essential == essential &&
             other.contact == static_cast<int>(contact.size()) &&
             std::equal(contact.begin(), contact.end(), other.keep.end() - other.contact) &&
             equal_operators(*other.K, K);
   };
   if (alike && alike->op && shares(*alike->op)) { result.op = alike->op; }
   else
   {
      result.op = factored(body, essential, contact, settings.backend);
      ++result.counters.factorisations;
   }
   const CondensedBody::Operator &op = *result.op;
   const FrameChange frames = frames_of(line, body.geometry());
   // Loads: one column a pattern. K d is needed once more below, at contact and essential dofs.
   const auto &patterns = body.patterns();
   const auto count = static_cast<Eigen::Index>(patterns.size());
   const int interior = op.interior(), size = static_cast<int>(op.keep.size());
   auto loads = std::make_shared<CondensedBody::Loads>();
   loads->interior = Eigen::MatrixXd::Zero(interior, count);
   loads->contact = Eigen::MatrixXd::Zero(op.contact, count);
   loads->prescribed = Eigen::MatrixXd::Zero(essential.size(), count);
   Eigen::MatrixXd at_contact(op.contact, count);         // F_C, or -K_CD d
   Eigen::MatrixXd at_essential(essential.size(), count); // F_D, or K_DD d
   mfem::Vector product(K.Height());
   for (Eigen::Index k = 0; k < count; ++k)
   {
      const bool force = patterns[k].control == Control::force;
      const mfem::Vector &values = patterns[k].values;
      if (!force) { K.Mult(values, product); }
      const mfem::Vector &source = force ? values : product;
      const double sign = force ? 1.0 : -1.0;
      for (int a = 0; a < interior; ++a) { loads->interior(a, k) = sign * source(op.keep[a]); }
      for (int a = 0; a < op.contact; ++a) { at_contact(a, k) = sign * source(contact[a]); }
      for (std::size_t a = 0; a < essential.size(); ++a)
      {
         at_essential(a, k) = source(essential[a]);
         if (!force) { loads->prescribed(a, k) = values(essential[a]); }
      }
   }
   Eigen::MatrixXd S = op.S, clamped(op.contact, count);
   result.H = Eigen::MatrixXd::Zero(count, count);
   Eigen::MatrixXd response(count, count);
   if (count > 0)
   {
      Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(size, count);
      rhs.topRows(interior) = loads->interior;
      const Eigen::MatrixXd U = op.factor->solve(rhs);
      result.counters.back_substitutions += count;
      loads->contact = U.bottomRows(op.contact);
      // With springs on the contact nodes instead of clamps: K_CI K_II⁻¹ r = -(S + shift) U_C,
      // and r'ᵀ K_II⁻¹ r = r'ᵀ U_I - U'_Cᵀ (S + shift) U_C.
      const Eigen::MatrixXd released = op.S * loads->contact + op.shift * loads->contact;
      clamped = -released - at_contact;
      response = loads->interior.transpose() * U.topRows(interior) -
                 loads->contact.transpose() * released;
   }
   impose_equilibrium(free, S, clamped);
   result.S = frames.both(S);
   if (count > 0)
   {
      const Eigen::MatrixXd local = frames.rows(clamped);
      for (Eigen::Index k = 0; k < count; ++k)
      {
         result.patterns.push_back({patterns[k].name, patterns[k].control, local.col(k).head(n),
                                    local.col(k).tail(op.contact - n)});
         for (Eigen::Index j = 0; j < count; ++j)
         {
            const bool force = patterns[k].control == Control::force;
            double &h = result.H(k, j);
            if (patterns[j].control == patterns[k].control)
            {
               // Flexibility of forces, or stiffness of prescribed displacements.
               h = 0.5 * (response(k, j) + response(j, k));
               if (!force)
               {
                  h = 0.5 * (loads->prescribed.col(k).dot(at_essential.col(j)) +
                             loads->prescribed.col(j).dot(at_essential.col(k))) -
                      h;
               }
            }
            else
            {
               // Displacement of force f by motion d; the support's reaction is its opposite.
               const Eigen::Index f = force ? k : j, d = force ? j : k;
               h = at_essential.col(f).dot(loads->prescribed.col(d)) + response(f, d);
               if (!force) { h = -h; }
            }
         }
      }
   }
   result.loads = std::move(loads);
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
