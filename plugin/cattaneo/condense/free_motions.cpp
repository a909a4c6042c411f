#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/condense/free_motions.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

namespace
{

/// The effect of blocks on the dofs of a part.
class BlocksOfPart
{
public:
   BlocksOfPart(const AssembledBody &body, const std::vector<int> &part)
   {
      std::vector<int> rows;
      for (std::size_t k = 0; k < part.size(); ++k)
      {
         const auto moves = [&](const BlockMotion &block)
         { return block.motion[part[k]] != 0; };
         if (std::any_of(body.blocks.begin(), body.blocks.end(), moves))
         {
            rows_.push_back(static_cast<int>(k));
            rows.push_back(part[k]);
         }
      }
      for (std::size_t b = 0; b < body.blocks.size() && !rows_.empty(); ++b)
      {
         const Eigen::VectorXd motion = body.blocks[b].motion(rows);
         if (motion.isZero(0)) { continue; }
         numbers_.push_back(b);
         motions_.conservativeResize(motion.size(), motions_.cols() + 1);
         motions_.rightCols(1) = motion;
      }
   }
   /// The rigid motions of the part, as columns, that its blocks allow.
   Eigen::MatrixXd allowed(const Eigen::MatrixXd &rigid) const
   {
      if (rows_.empty() || rigid.cols() == 0) { return rigid; }
      const Eigen::MatrixXd Q = thin_qr(rigid).Q, here = Q(rows_, Eigen::all),
                            M = thin_qr(motions_).Q;
      const Eigen::MatrixXd rest = here - M * (M.transpose() * here);
      return at_rest(Q, rest / here.norm());
   }
   /// By how much a motion of the part, which its blocks allow, moves each block.
   std::vector<std::pair<std::size_t, double>> amplitudes(const Eigen::VectorXd &motion) const
   {
      std::vector<std::pair<std::size_t, double>> all;
      if (rows_.empty()) { return all; }
      const Eigen::VectorXd a = least_squares(motions_, motion(rows_));
      for (std::size_t k = 0; k < numbers_.size(); ++k)
      {
         all.emplace_back(numbers_[k], a[static_cast<Eigen::Index>(k)]);
      }
      return all;
   }

private:
   std::vector<int> rows_; ///< of the part
   Eigen::MatrixXd motions_;
   std::vector<std::size_t> numbers_;
};

} // namespace

FreeMotions find_free_motions(const AssembledBody &body, const std::vector<int> &contact)
{
   const SparseView K = body.K.view();
   const DofPlaces &places = body.places;
   std::vector<bool> supported(K.rows(), false);
   for (int dof : body.fixed) { supported[dof] = true; }
   for (const BlockMotion &block : body.blocks)
   {
      for (int dof : body.fixed) { supported[dof] = supported[dof] && block.motion[dof] == 0; }
   }
   std::vector<bool> held = supported;
   for (int dof : contact) { held[dof] = true; }
   const auto count = static_cast<Eigen::Index>(body.loads.size());
   FreeMotions free;
   free.contact.resize(contact.size(), 0);
   free.resultant.resize(0, count);
   const std::vector<std::vector<int>> parts = body.K.connected_parts();
   for (const std::vector<int> &part : parts)
   {
      const BlocksOfPart blocks(body, part);
      const auto motions = [&](const std::vector<bool> &holding)
      {
         const Eigen::MatrixXd rigid =
            blocks.allowed(free_rigid_motions(places, part, holding));
         return body.grounded ? unresisted(K, part, rigid) : rigid;
      };
      const Eigen::MatrixXd still = motions(held);
      if (still.cols() > 0)
      {
         const int dof = part.front();
         require(false, "unsupported body: supports (", body.fixed.size(),
                 " dofs) and contact nodes (", contact.size() / components(places.formulation),
                 ") together leave ", still.cols(), " rigid motion(s) free",
                 parts.size() > 1 ? " of the separate part" : "", " of the body with the node ",
                 places.called(dof), ", must leave none free");
      }
      // Elements of lower order than their geometry resist rotation a little: no equilibrium
      // there.
      const Eigen::MatrixXd possible = motions(supported);
      const Eigen::MatrixXd rigid = unresisted(K, part, possible);
      free.count += static_cast<int>(possible.cols());
      for (Eigen::Index m = 0; m < rigid.cols(); ++m)
      {
         Eigen::VectorXd whole = Eigen::VectorXd::Zero(K.rows());
         for (std::size_t k = 0; k < part.size(); ++k) { whole[part[k]] = rigid(k, m); }
         free.contact.conservativeResize(Eigen::NoChange, free.contact.cols() + 1);
         free.resultant.conservativeResize(free.resultant.rows() + 1, Eigen::NoChange);
         free.contact.rightCols(1) = whole(contact);
         for (Eigen::Index k = 0; k < count; ++k)
         {
            // Prescribed displacements strain the body; their forces do no work on rigid
            // motions.
            const BodyLoad &load = body.loads[k];
            free.resultant(free.resultant.rows() - 1, k) =
               load.control == Control::force ? whole.dot(load.values) : 0.0;
            for (const auto &[b, amplitude] : blocks.amplitudes(rigid.col(m)))
            {
               if (body.blocks[b].load != load.name) { continue; }
               free.resultant(free.resultant.rows() - 1, k) += body.blocks[b].force * amplitude;
            }
         }
      }
   }
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
   if (Q_.cols() > 0) { remove_motions(S, Q_); }
}

} // namespace cattaneo
