#include <algorithm>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/condense/condense_joint.hpp>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/input_error.hpp>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Computes displacements from a field in relative coordinates.
class JointSolver : public BodySolver
{
public:
   std::shared_ptr<const BodySolver> relative;
   std::vector<std::pair<int, int>> follows; ///< rows of the first body, and of their partners

   VectorXd recover(const VectorXd &contact, const VectorXd &multipliers,
                    Counters &counters) const override
   {
      VectorXd field = relative->recover(contact, multipliers, counters);
      for (const auto &[row, partner] : follows) { field[row] += field[partner]; }
      return field;
   }
   double error(const Eigen::MatrixXd &S, const Eigen::MatrixXd &motions,
                Counters &counters) const override
   {
      return relative->error(S, motions, counters);
   }
};

/// The surface of the first body, in frames between those of both bodies, with mean weights.
ContactSurface surface_between(const ContactSurface &one, const ContactSurface &other,
                               const std::vector<int> &partner)
{
   const Index n = one.size();
   require(other.size() == n && static_cast<Index>(partner.size()) == n,
           "condense joint: the contact surfaces have ", n, " and ", other.size(),
           " nodes and the pairing has ", partner.size(), ", must be the same number");
   std::set<int> taken;
   ContactSurface between = one;
   for (Index i = 0; i < n; ++i)
   {
      const int k = partner[i];
      require(k >= 0 && k < n && taken.insert(k).second, "condense joint: partner ", k,
              " in the pairing, must be each of 0 to ", n - 1, " once");
      SurfaceNode &node = between.nodes[i];
      const SurfaceNode &its = other.nodes[k];
      const std::string where = place_text(node.position, Formulation::space);
      require(node.normal().dot(its.normal()) < 0,
              "condense joint: the bodies do not face each other at the contact node ", where);
      std::set<Index> ends, facing;
      for (Index end : node.between) { ends.insert(end < 0 ? end : partner[end]); }
      for (Index end : its.between) { facing.insert(end); }
      require(ends == facing, "condense joint: the node ", where,
              " is in the middle of an edge of only one body, must be so in both or in none");
      node.frame = frame_between(node.frame, its.frame, false);
      node.weight = (node.weight + its.weight) / 2;
      node.spacing = std::min(node.spacing, its.spacing);
   }
   return between;
}

/// Both bodies as one, in relative coordinates: rows of the first body, then those of the
/// second.
class Joint
{
public:
   AssembledBody all;

   Joint(const AssembledBody &body1, const AssembledBody &body2,
         const std::vector<std::pair<int, int>> &rows)
      : first_(body1), second_(body2), size_(body1.K.size()), partner_(size_, -1)
   {
      for (const auto &[row, partner] : rows) { partner_[row] = partner; }
      all.grounded = body1.grounded || body2.grounded;
      stiffness();
      places();
      supports();
      for (const BodyLoad &load : first_.loads) { add(load, true); }
      for (const BodyLoad &load : second_.loads) { add(load, false); }
   }

private:
   const AssembledBody &first_, &second_;
   const int size_;
   std::vector<int> partner_; ///< of rows of the first body, -1: none

   /// TᵀKT: a force on a contact node of the first body acts on the node's partner too.
   void stiffness()
   {
      const SparseView K = first_.K.view(), L = second_.K.view();
      const auto rows = static_cast<Index>(size_) + second_.K.size();
      std::vector<Eigen::Triplet<double>> entries;
      entries.reserve(K.nonZeros() + K.nonZeros() / 4 + L.nonZeros());
      for (int row = 0; row < size_; ++row)
      {
         for (SparseView::InnerIterator e(K, row); e; ++e)
         {
            const int column = static_cast<int>(e.col()), own = partner_[row],
                      its = partner_[column];
            entries.emplace_back(row, column, e.value());
            if (own >= 0) { entries.emplace_back(own, column, e.value()); }
            if (its >= 0) { entries.emplace_back(row, its, e.value()); }
            if (own >= 0 && its >= 0) { entries.emplace_back(own, its, e.value()); }
         }
      }
      for (int row = 0; row < second_.K.size(); ++row)
      {
         for (SparseView::InnerIterator e(L, row); e; ++e)
         {
            entries.emplace_back(size_ + row, size_ + static_cast<int>(e.col()), e.value());
         }
      }
      Eigen::SparseMatrix<double, Eigen::RowMajor> joined(rows, rows);
      joined.setFromTriplets(entries.begin(), entries.end());
      all.K = SharedMatrix(std::move(joined));
   }
   void places()
   {
      all.places = first_.places;
      const DofPlaces &more = second_.places;
      const auto together = [](VectorXd &to, const VectorXd &add)
      {
         const Index before = to.size();
         to.conservativeResize(before + add.size());
         to.tail(add.size()) = add;
      };
      together(all.places.x, more.x);
      together(all.places.y, more.y);
      together(all.places.z, more.z);
      all.places.component.insert(all.places.component.end(), more.component.begin(),
                                  more.component.end());
   }
   bool fixes_partner(int row) const
   {
      return std::binary_search(second_.fixed.begin(), second_.fixed.end(),
                                partner_[row] - size_);
   }
   void supports()
   {
      for (int row : first_.fixed)
      {
         // A support of only the first body would be a relation between coordinates.
         require(partner_[row] < 0 || fixes_partner(row),
                 "condense joint: supports hold component ",
                 component_name(Formulation::space, first_.places.component[row]),
                 " of the contact node at ", first_.places.called(row),
                 " in the first body only, must hold it in the second or in both: name the "
                 "bodies the other way round, or condense each on its own");
         all.fixed.push_back(row);
      }
      for (int row : second_.fixed) { all.fixed.push_back(size_ + row); }
   }
   void add(const BodyLoad &load, bool of_first)
   {
      BodyLoad *found = nullptr;
      for (BodyLoad &each : all.loads)
      {
         if (each.name == load.name) { found = &each; }
      }
      if (!found)
      {
         all.loads.push_back({load.name, load.control, VectorXd::Zero(all.K.size())});
         found = &all.loads.back();
      }
      require(found->control == load.control, "condense joint: load '", load.name,
              "' is controlled by force in one body and by displacement in the other, must be "
              "the same in both");
      VectorXd &values = found->values;
      if (!of_first)
      {
         values.tail(load.values.size()) += load.values;
         return;
      }
      values.head(size_) += load.values;
      for (int row = 0; row < size_; ++row)
      {
         if (partner_[row] < 0 || load.values[row] == 0) { continue; }
         require(load.control == Control::force, "condense joint: load '", load.name,
                 "' moves the contact node at ", first_.places.called(row),
                 " of the first body, must move none: end the contact before it");
         values[partner_[row]] += load.values[row];
      }
   }
};

} // namespace

CondensedBody condense_joint(const AssembledBody &body1, const ContactSurface &surface1,
                             const AssembledBody &body2, const ContactSurface &surface2,
                             const std::vector<int> &partner)
{
   for (const AssembledBody *body : {&body1, &body2})
   {
      require(body->places.formulation == Formulation::space && body->blocks.empty(),
              "condense joint: both bodies must be in space, and without blocks");
      body->validate();
   }
   surface1.validate();
   surface2.validate();
   const AssembledBody first = with_eliminated(body1), second = with_eliminated(body2);
   // 1. Find the rows of matching nodes.
   const Trace one(surface1), other(surface2);
   ContactDofs contact = contact_dofs(one, Formulation::space, first.K.size());
   const ContactDofs its = contact_dofs(other, Formulation::space, second.K.size());
   require_in_place(one, first.places);
   require_in_place(other, second.places);
   const ContactSurface surface = surface_between(surface1, surface2, partner);
   const Index n = surface.size();
   std::vector<std::pair<int, int>> rows;
   for (Index i = 0; i < n; ++i)
   {
      for (Index c = 0; c < 3; ++c)
      {
         rows.emplace_back(contact.all[c * n + i],
                           first.K.size() + its.all[c * n + partner[i]]);
      }
   }
   for (std::size_t a = 0; a < contact.all.size(); ++a)
   {
      if (std::binary_search(first.fixed.begin(), first.fixed.end(), contact.all[a]))
      {
         contact.held.push_back(static_cast<int>(a));
      }
   }
   const Joint joint(first, second, rows);
   // 2. Find the free motions of the first body. The second body has none.
   const int loose = find_free_motions(second, its.all).count;
   require(loose == 0, "condense joint: supports leave ", loose,
           " rigid motion(s) of the second body free, must hold it: name the bodies the other "
           "way round, or condense each on its own");
   FreeMotions free = find_free_motions(first, contact.free());
   free.resultant.conservativeResize(Eigen::NoChange,
                                     static_cast<Index>(joint.all.loads.size()));
   free.resultant.rightCols(free.resultant.cols() - static_cast<Index>(first.loads.size()))
      .setZero();
   // 3. Factor both together.
   Condensation found = condense_by_factor(joint.all, contact.free(), nullptr, std::move(free));
   auto solver = std::make_shared<JointSolver>();
   solver->relative = std::move(found.solver);
   solver->follows = std::move(rows);
   found.solver = std::move(solver);
   return in_local_frames(surface, joint.all.loads, contact, std::move(found));
}

} // namespace cattaneo
