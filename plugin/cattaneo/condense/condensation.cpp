#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <numeric>

namespace cattaneo
{

namespace
{

/// Puts rows at their positions among so many, and zeros elsewhere.
void spread(Eigen::MatrixXd &M, const std::vector<int> &positions, Eigen::Index rows)
{
   const Eigen::MatrixXd dense = std::move(M);
   M = Eigen::MatrixXd::Zero(rows, dense.cols());
   M(positions, Eigen::all) = dense;
}

/// The line meets its supports, and the rows in its frames that these hold.
std::vector<int> align(ContactLine &line, const ContactDofs &contact)
{
   const std::vector<int> &held = contact.held;
   if (line.formulation == Formulation::torsion) { return held; }
   const auto n = static_cast<int>(line.size());
   HeldComponents components = HeldComponents::Constant(n, 2, false), moved = components;
   for (int position : held)
   {
      components(position % n, position / n) = true;
      moved(position % n, position / n) =
         std::count(contact.in_moved_plane.begin(), contact.in_moved_plane.end(), position) > 0;
   }
   meet_supports(line, components, moved);
   std::vector<int> rows;
   for (int position : held)
   {
      const int i = position % n, c = position / n;
      const bool both = components(i, 0) && components(i, 1);
      rows.push_back(both ? position : nearest_axis(line.nodes[i].tangent) == c ? i : n + i);
   }
   std::sort(rows.begin(), rows.end());
   return rows;
}

} // namespace

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

std::vector<int> others(const std::vector<int> &held, Eigen::Index count)
{
   std::vector<int> all(count), rest;
   std::iota(all.begin(), all.end(), 0);
   std::set_difference(all.begin(), all.end(), held.begin(), held.end(),
                       std::back_inserter(rest));
   return rest;
}

std::vector<int> ContactDofs::free_positions() const
{
   return others(held, static_cast<Eigen::Index>(all.size()));
}

std::vector<int> ContactDofs::free() const
{
   std::vector<int> dofs;
   for (int position : free_positions()) { dofs.push_back(all[position]); }
   require(
      !dofs.empty(), "condense: all components of all ", all.size(),
      " contact dofs are fixed, one at least must be free: supports hold all of the part of "
      "the boundary that is named as contact, is it the one that touches?");
   return dofs;
}

ContactDofs contact_dofs(const ContactLine &line, Formulation formulation, int dofs)
{
   line.validate();
   require(line.formulation == formulation, "condense: the contact line is ",
           name(line.formulation), ", the body ", name(formulation),
           ", must be the same (is it a line of this body?)");
   const auto n = line.size();
   std::vector<int> contact(components(formulation) * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (int c = 0; c < components(formulation); ++c)
      {
         const int dof = line.nodes[i].dofs[c];
         require(dof >= 0 && dof < dofs, "condense: contact dof ", dof, " of node ", i,
                 " of the line, must be from 0 to ", dofs - 1, " (is it a line of this body?)");
         contact[c * n + i] = dof;
      }
   }
   return {contact, {}};
}

void ContactDofs::move(int position, Eigen::Index load, double by, const ContactLine &line,
                       const std::vector<BodyLoad> &loads)
{
   if (line.formulation == Formulation::torsion)
   {
      refuse_motion(line, position, "is turned by load pattern '" + loads[load].name + "'");
   }
   if (moved.size() == 0)
   {
      moved = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(all.size()),
                                    static_cast<Eigen::Index>(loads.size()));
   }
   moved(position, load) = by;
}

bool moves_plane(const ContactLine &line, int position, const DofPlaces &places,
                 const std::vector<int> &fixed, const std::vector<BodyLoad> &loads)
{
   const auto n = static_cast<int>(line.size());
   const int c = position / n;
   const LineNode &node = line.nodes[position % n];
   const Eigen::VectorXd &along = c == 0 ? places.x : places.y;
   return std::any_of(fixed.begin(), fixed.end(),
                      [&](int dof)
                      {
                         return places.component[dof] == c &&
                                std::abs(along[dof] - node.position[c]) <=
                                   1e-6 * node.spacing &&
                                std::any_of(loads.begin(), loads.end(),
                                            [&](const BodyLoad &load) {
                                               return load.control == Control::displacement &&
                                                      load.values[dof] != 0;
                                            });
                      });
}

void refuse_motion(const ContactLine &line, int position, const std::string &how)
{
   const auto n = static_cast<int>(line.size());
   throw InputError(
      std::string("condense: component ") + component_name(line.formulation, position / n) +
      " of the contact node at " + as_text(line.nodes[position % n].position) + " " + how +
      ", contact nodes must be free, held or moved by a load: the contact must end before it");
}

CondensedBody in_local_frames(const ContactLine &line, const std::vector<BodyLoad> &loads,
                              const ContactDofs &contact, Condensation found)
{
   CondensedBody result;
   result.line = line;
   if (!contact.held.empty())
   {
      result.held = align(result.line, contact);
      result.moved = contact.moved;
      const std::vector<int> free = contact.free_positions();
      const auto rows = static_cast<Eigen::Index>(contact.all.size());
      spread(found.S, free, rows);
      found.S.transposeInPlace();
      spread(found.S, free, rows);
      spread(found.free.contact, free, rows);
      spread(found.clamped.forces, free, rows);
   }
   result.counters = found.counters;
   result.solver = std::move(found.solver);
   result.rigid_modes = found.free.count;
   result.H = found.H.size() > 0 || loads.empty() ? std::move(found.H)
                                                  : load_by_load(loads, found.clamped);
   const Equilibrium equilibrium(found.free);
   equilibrium.impose_on_stiffness(found.S);
   equilibrium.impose_on_forces(found.clamped.forces);
   const FrameChange frames = FrameChange::of(result.line, result.held);
   result.S = frames.both(std::move(found.S));
   // Displacements change with the frames as forces do, but for those of torsion, r times the
   // twist.
   const Eigen::MatrixXd &motions = equilibrium.motions();
   result.free_motions = line.formulation == Formulation::torsion
                            ? thin_qr(frames.a.cwiseInverse().asDiagonal() * motions).Q
                            : frames.inverse().transposed().rows(motions);
   if (line.formulation != Formulation::torsion && motions.cols() > 0 && !frames.rotates())
   {
      result.free_motions = thin_qr(result.free_motions).Q;
   }
   Eigen::MatrixXd local = frames.rows(found.clamped.forces);
   for (int row : result.held) // not even round-off of the free motions
   {
      result.S.row(row).setZero();
      result.S.col(row).setZero();
      result.free_motions.row(row).setZero();
      local.row(row).setZero();
   }
   const auto n = line.size();
   for (std::size_t k = 0; k < loads.size(); ++k)
   {
      const auto force = local.col(static_cast<Eigen::Index>(k));
      result.patterns.push_back(
         {loads[k].name, loads[k].control, force.head(n), force.tail(local.rows() - n)});
   }
   return result;
}

} // namespace cattaneo
