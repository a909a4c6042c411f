#include <algorithm>
#include <cattaneo/condense/free_motions.hpp>
#include <cattaneo/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <numeric>

namespace cattaneo
{

FreeMotions find_free_motions(const WholeBody &body, bool has_material,
                              const std::vector<int> &contact)
{
   const mfem::SparseMatrix &K = *body.K;
   const DofPlaces &places = body.places;
   std::vector<bool> supported(K.Height(), false);
   for (int dof : body.essential) { supported[dof] = true; }
   std::vector<bool> held = supported;
   for (int dof : contact) { held[dof] = true; }
   const auto count = static_cast<Eigen::Index>(body.patterns.size());
   FreeMotions free;
   free.contact.resize(contact.size(), 0);
   free.resultant.resize(0, count);
   const std::vector<std::vector<int>> parts = connected_parts(K);
   for (const std::vector<int> &part : parts)
   {
      const auto motions = [&](const std::vector<bool> &holding)
      {
         const Eigen::MatrixXd rigid = free_rigid_motions(places, part, holding);
         return has_material ? rigid : unresisted(K, part, rigid);
      };
      const Eigen::MatrixXd still = motions(held);
      if (still.cols() > 0)
      {
         const int dof = part.front();
         require(false, "unsupported body: supports (", body.essential.size(),
                 " dofs) and contact nodes (", contact.size() / components(places.geometry),
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
            const auto &pattern = body.patterns[k];
            const Eigen::Map<const Eigen::VectorXd> forces(pattern.values.GetData(),
                                                           K.Height());
            free.resultant(free.resultant.rows() - 1, k) =
               pattern.control == Control::force ? whole.dot(forces) : 0.0;
         }
      }
   }
   return free;
}

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

Equilibrium::Equilibrium(const FreeMotions &free)
{
   const Eigen::Index count = free.contact.cols();
   Q_.resize(free.contact.rows(), count);
   if (count == 0) { return; }
   const ThinQR qr = thin_qr(free.contact);
   Q_ = qr.Q;
   // Contact forces and loads together do no work: (Q R)ᵀ f = -resultant.
   balance_ = -qr.R.transpose().triangularView<Eigen::Lower>().solve(free.resultant);
}

void Equilibrium::impose_on_forces(Eigen::MatrixXd &f) const
{
   if (Q_.cols() > 0) { f += Q_ * (balance_ - Q_.transpose() * f); }
}

void Equilibrium::impose_on_stiffness(Eigen::MatrixXd &S) const
{
   if (Q_.cols() == 0) { return; }
   const Eigen::MatrixXd SQ = S * Q_;
   S += Q_ * (Q_.transpose() * SQ) * Q_.transpose() - Q_ * SQ.transpose() - SQ * Q_.transpose();
   S = (0.5 * (S + S.transpose())).eval();
}

Eigen::VectorXd Equilibrium::without_motions(const Eigen::VectorXd &x) const
{
   return x - Q_ * (Q_.transpose() * x);
}

} // namespace cattaneo
