#include "contact/reactions.hpp"

#include <algorithm>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// Forces on a body, and their moment about the origin. In axisymmetry only forces along the
/// axis add up.
struct Sum
{
   Vector2d force{0, 0}, middle{0, 0};
   double moment = 0, size = 0, lever = 0;
   int places = 0;

   void add(const Vector2d &at, const Vector2d &its)
   {
      force += its;
      moment += at[0] * its[1] - at[1] * its[0];
      size += its.norm();
      lever += at.norm() * its.norm();
      middle += at;
      ++places;
   }
   void add(const Sum &other)
   {
      force += other.force;
      moment += other.moment;
      size += other.size;
      lever += other.lever;
   }
   Vector2d about() const { return places ? Vector2d(middle / places) : middle; }
   /// The largest of the terms and of their sum.
   double largest() const { return force.cwiseAbs().maxCoeff(); }
};

/// All forces on one body.
class Forces
{
public:
   Forces(OwnBodies &own, const BoltsReport &bolts, const JointCase &joint, int body,
          const ContactState &state)
      : reduction_(own.scene.reduction), held_(own.held[body]), body_(body),
        plane_(joint.formulation == Formulation::plane), thickness_(joint.thickness_of(body)),
        state_(state), loads_(state.multipliers)
   {
      // For a bolt its force, not its pretension.
      const std::vector<double> shanks = bolts.shanks(state);
      for (std::size_t k = 0; k < shanks.size(); ++k)
      {
         loads_[reduction_.problem.pattern(joint.bolts[k].name)] =
            shanks[k] / joint.bolts[k].force;
      }
      add_interfaces();
      if (held_.K.size() == 0) { return; }
      add_loads();
      add_holdings();
      if (held_.around.K.size() > 0) { add_torques(); }
   }

   struct Named
   {
      std::string kind, name;
      Sum sum;
      double torque = 0, torque_size = 0; ///< around the axis
   };
   const std::vector<Named> &held() const { return named_; }
   const Sum &contact() const { return contact_; }
   bool known() const { return held_.K.size() > 0; }
   /// The sum of all forces divided by the largest one. NaN: there is no force, or the forces
   /// of supports are known only from the balance.
   double imbalance() const
   {
      if (held_.supports_left_out) { return none; }
      Sum all = loaded_;
      all.add(contact_);
      double largest = std::max(contact_largest_, loaded_largest_), reach = 0;
      for (const Named &one : named_)
      {
         all.add(one.sum);
         largest = std::max(largest, one.sum.largest());
      }
      for (const Vector2d &place : held_.place) { reach = std::max(reach, place.norm()); }
      // Torques that are round-off of forces at their levers count as zero.
      const double turns =
         torque_largest_ > 1e-12 * largest * reach ? std::abs(torque_) / torque_largest_ : none;
      // The round-off of resultants is measured by the forces at the nodes.
      if (largest < 1e-12 * all.size) { largest = all.size; }
      if (largest == 0) { return turns; }
      // NaN, for bodies that do not turn, is not larger than any number.
      if (!plane_) { return std::fmax(std::abs(all.force[1]) / largest, turns); }
      return std::max(all.largest(), std::abs(all.moment) / reach) / largest;
   }

private:
   /// Resultants at the places where they act on this body.
   void add_interfaces()
   {
      tied_ = reduction_.tied_forces(state_.v, state_.w, state_.multipliers);
      for (const InterfaceReport &face : reduction_.interfaces)
      {
         for (const int side : {0, 1})
         {
            if (face.bodies[side] != body_) { continue; }
            Sum its;
            for (Index i = 0; i < face.nodes; ++i)
            {
               const Index k = face.first + i;
               const double q = face.tied             ? tied_[k]
                                : state_.q.size() > 0 ? state_.q[k]
                                                      : 0.0,
                            p = face.tied ? tied_[tied_.size() / 2 + k] : state_.p[k];
               const Vector2d t = face.tangent.row(i), n(-t[1], t[0]);
               its.add(face.acts_at[side].row(i), (side ? -1 : 1) * (q * t + p * n));
            }
            contact_largest_ = std::max(contact_largest_, its.largest());
            contact_.add(its);
            if (face.bodies[1] < 0)
            {
               named_.push_back({face.tied ? "tie" : "obstacle", face.name, its});
               obstacles_.add(its);
            }
         }
      }
      // These dofs are listed among those that hold the body.
      contact_.force -= obstacles_.force;
      contact_.moment -= obstacles_.moment;
   }

   void add_loads()
   {
      field_ = VectorXd::Zero(held_.K.size());
      for (const BodyLoad &load : held_.loads)
      {
         if (load.control != Control::force) { continue; }
         const double factor = thickness_ * loads_[reduction_.problem.pattern(load.name)];
         Sum its;
         for (Index dof = 0; dof < load.values.size(); ++dof)
         {
            if (load.values[dof] == 0) { continue; }
            field_[dof] += factor * load.values[dof];
            its.add(held_.place[dof], along(dof, factor * load.values[dof]));
         }
         loaded_largest_ = std::max(loaded_largest_, its.largest());
         loaded_.add(its);
      }
   }

   void add_holdings()
   {
      const VectorXd u = reduction_.displacement(body_, state_.v, state_.w, state_.multipliers);
      VectorXd rest = thickness_ * (held_.K.view() * u) - field_;
      const ContactLine &line = reduction_.bodies[body_].line;
      const Index n = reduction_.problem.nodes();
      const Eigen::MatrixX2d contact = reduction_.contact_forces(
         body_, state_.q.size() ? VectorXd(state_.q.head(n)) : VectorXd(), state_.p, tied_);
      for (Index i = 0; i < line.size(); ++i)
      {
         for (const int c : {0, 1}) { rest[line.nodes[i].dofs[c]] -= contact(i, c); }
      }
      // The force of an eliminated row is lost. It is then part of the remainder below.
      const auto lost = [&](int dof)
      {
         using Entries = std::decay_t<decltype(held_.K.view())>;
         for (typename Entries::InnerIterator entry(held_.K.view(), dof); entry; ++entry)
         {
            if (entry.col() != dof && entry.value() != 0) { return false; }
         }
         return true;
      };
      for (const Holding &one : held_.holdings)
      {
         if (held_.supports_left_out && std::all_of(one.dofs.begin(), one.dofs.end(), lost))
         {
            continue;
         }
         Sum its;
         for (const int dof : one.dofs) { its.add(held_.place[dof], along(dof, rest[dof])); }
         named_.push_back({one.kind, one.name, its});
      }
      if (!held_.supports_left_out) { return; }
      Sum left;
      left.force = -loaded_.force - contact_.force;
      left.moment = -loaded_.moment - contact_.moment;
      for (const Named &one : named_)
      {
         left.force -= one.sum.force;
         left.moment -= one.sum.moment;
      }
      named_.push_back({"support", "left out of the matrix", left});
   }

   /// Around the axis: torques of loads, contact, supports and prescribed turns.
   void add_torques()
   {
      const HeldBody::Around &around = held_.around;
      const Index n = reduction_.problem.nodes();
      VectorXd rest = around.K.view() * reduction_.twist(body_, state_.v, state_.multipliers);
      const auto add = [&](double torque)
      {
         torque_ += torque;
         torque_largest_ = std::max(torque_largest_, std::abs(torque));
      };
      for (const BodyLoad &load : around.loads)
      {
         if (load.control != Control::force) { continue; }
         const double factor = loads_[reduction_.problem.pattern(load.name)];
         rest -= factor * load.values;
         add(factor * load.values.sum());
      }
      const VectorXd tied = reduction_.tied_twisting(state_.v, state_.multipliers),
                     around_axis = state_.q.tail(n),
                     contact = reduction_.contact_torques(body_, around_axis, tied);
      for (const InterfaceReport &face : reduction_.interfaces)
      {
         if (face.bodies[1] >= 0 || face.bodies[0] != body_) { continue; }
         const auto its = std::find_if(named_.begin(), named_.end(),
                                       [&](const Named &named) {
                                          return named.name == face.name &&
                                                 named.kind == (face.tied ? "tie" : "obstacle");
                                       });
         for (Index i = 0; i < face.nodes; ++i)
         {
            const double q = (face.tied ? tied : around_axis)[face.first + i],
                         torque = face.position(i, 0) * q;
            its->torque += torque;
            its->torque_size += std::abs(torque);
         }
      }
      const ContactLine &line = reduction_.torsion[body_].line;
      for (Index i = 0; i < line.size(); ++i) { rest[line.nodes[i].dofs[0]] -= contact[i]; }
      // The forces of two interfaces may balance each other.
      add(contact.sum());
      torque_largest_ = std::max(torque_largest_, contact.lpNorm<1>());
      for (const Holding &one : around.holdings)
      {
         double torque = 0, size = 0;
         for (const int dof : one.dofs)
         {
            torque += rest[dof];
            size += std::abs(rest[dof]);
         }
         add(torque);
         Sum at; // no force, only the place
         for (const int dof : one.dofs) { at.add(around.place[dof], {0, 0}); }
         auto its = std::find_if(named_.begin(), named_.end(),
                                 [&](const Named &named)
                                 { return named.kind == one.kind && named.name == one.name; });
         if (its == named_.end())
         {
            named_.push_back({one.kind, one.name, at});
            its = named_.end() - 1;
         }
         its->torque += torque;
         its->torque_size += size;
      }
   }

   Vector2d along(Index dof, double force) const
   {
      Vector2d made(0, 0);
      if (plane_ || held_.component[dof] == 1) { made[held_.component[dof]] = force; }
      return made;
   }

   Reduction &reduction_;
   const HeldBody &held_;
   int body_;
   bool plane_;
   double thickness_;
   const ContactState &state_;
   VectorXd loads_, tied_, field_;
   Sum contact_, obstacles_, loaded_;
   double contact_largest_ = 0, loaded_largest_ = 0, torque_ = 0, torque_largest_ = 0;
   std::vector<Named> named_;
};

} // namespace

void report_reactions(Study &study, const JointCase &joint, OwnBodies &own,
                      const BoltsReport &bolts, const ContactState &state)
{
   const bool plane = joint.formulation == Formulation::plane;
   const Units &u = study.units;
   const bool twists = !own.scene.reduction.torsion.empty();
   ResultTable &reactions = study.table(
      "reactions", {{"body", "forces on"},
                    {"kind", "by"},
                    {"name", "called"},
                    {"force_x", headed(plane ? "x" : "", u.total(0)), "%.6g"},
                    {"force_y", std::string(plane ? "y" : "axial") + u.total(0), "%.6g"},
                    {"moment", headed(plane ? "moment" : "", u.total(1)), "%.4g"},
                    {"torque", headed(twists ? "torque" : "", u.total(1)), "%.6g"},
                    {"about_x", headed(plane ? "about x" : "", u.of(0, 1)), "%.5g"},
                    {"about_y", headed(plane ? "y" : "", u.of(0, 1)), "%.5g"}});
   std::vector<std::pair<std::string, double>> balances;
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      const Forces forces(own, bolts, joint, static_cast<int>(b), state);
      const std::string &name = own.scene.reduction.bodies[b].name;
      const auto add = [&](const std::string &kind, const std::string &called, const Sum &sum,
                           double torque = 0)
      {
         const Vector2d about = sum.about();
         const double x = settled(sum.force[0], sum.size), y = settled(sum.force[1], sum.size),
                      moment =
                         settled(sum.moment - about[0] * sum.force[1] + about[1] * sum.force[0],
                                 2 * sum.lever);
         study.row(reactions, {name, kind, called, plane ? x : none, y, plane ? moment : none,
                               twists ? torque : none, about[0], about[1]});
      };
      for (const Forces::Named &one : forces.held())
      {
         add(one.kind, one.name, one.sum, settled(one.torque, one.torque_size));
      }
      if (joint.bodies[b].half_plane)
      {
         Sum far = forces.contact();
         far.force *= -1;
         far.moment *= -1;
         add("half-plane", "far away", far);
      }
      if (forces.known()) { balances.emplace_back(name, forces.imbalance()); }
   }
   ResultTable &balance = study.table(
      "balance", {{"body", "body"},
                  {"imbalance",
                   plane    ? "imbalance of forces and moments over the largest force"
                   : twists ? "imbalance of axial forces over the largest force, and of torques"
                            : "imbalance of axial forces over the largest force",
                   "%.1e"}});
   // One sentence, unless a body is out of balance by more than round-off, or its forces are
   // not known.
   double worst = 0;
   bool balanced = !balances.empty();
   for (const auto &[name, imbalance] : balances)
   {
      worst = std::max(worst, imbalance);
      balanced = balanced && imbalance < 1e-8;
   }
   balance.quiet(!study.verbose() && balanced);
   for (const auto &[name, imbalance] : balances) { study.row(balance, {name, imbalance}); }
   if (!study.verbose() && balanced)
   {
      study.say(text("\nEach body is in balance to %.1e of the largest force on it", worst));
   }
}

} // namespace miniapp
